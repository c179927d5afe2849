// The way to an engine: a server's, over a socket, or one that runs in a worker of this page.
// Both take requests and give replies and frames, as PROTOCOL.md says.

// Connects. `hear(reply)` is given each reply, `take(frame)` each frame of bytes, `gone()` the end.
export function connect({ hear, take, gone }) {
  const worker = document.documentElement.dataset.engine === "worker";
  return worker ? work({ hear, take, gone }) : call({ hear, take, gone });
}

function call({ hear, take, gone }) {
  const address = new URL("engine", document.baseURI);
  address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
  const socket = new WebSocket(address);
  socket.binaryType = "arraybuffer";
  socket.onmessage = ({ data }) => (typeof data === "string" ? hear(JSON.parse(data)) : take(frame(data)));
  socket.onclose = gone;
  return {
    send(request) {
      if (socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(request));
    },
  };
}

function work({ hear, take, gone }) {
  const worker = new Worker(new URL("worker.js", document.baseURI), { type: "module" });
  worker.onmessage = ({ data }) => (typeof data === "string" ? hear(JSON.parse(data)) : take(frame(data)));
  worker.onerror = gone;
  return {
    send(request) {
      worker.postMessage(JSON.stringify(request));
    },
  };
}

// The 24 bytes before a tile or a file, and what is behind them.
function frame(buffer) {
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
