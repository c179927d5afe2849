// The 24 bytes before a tile or a file, and what is behind them: PROTOCOL.md.

export function frame(buffer) {
  const head = new DataView(buffer, 0, 24);
  const number = (at) => head.getUint32(at, true);
  return {
    kind: { 1: "srgb8", 2: "linear", 3: "file" }[head.getUint8(0)],
    step: head.getUint8(1),
    pass: head.getUint16(2, true),
    picture: number(4),
    x: number(8),
    y: number(12),
    width: number(16),
    height: number(20),
    bytes: new Uint8ClampedArray(buffer, 24),
  };
}
