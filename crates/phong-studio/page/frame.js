// Messages of bytes, PROTOCOL.md: tiles, one after another, or a file. Each has 24 bytes before what is in it.

const KINDS = { 1: ["srgb8", 4], 2: ["linear", 16], 3: ["file", 0] };

// What a message holds, in order.
export function* frames(buffer) {
  for (let at = 0; at < buffer.byteLength; ) {
    const head = new DataView(buffer, at, 24);
    const number = (at) => head.getUint32(at, true);
    const [kind, each] = KINDS[head.getUint8(0)];
    const [width, height] = [number(16), number(20)];
    const length = kind === "file" ? buffer.byteLength - at - 24 : each * width * height;
    yield {
      kind,
      step: head.getUint8(1),
      pass: head.getUint16(2, true),
      picture: number(4),
      x: number(8),
      y: number(12),
      width,
      height,
      bytes: new Uint8ClampedArray(buffer, at + 24, length),
    };
    at += 24 + length;
  }
}
