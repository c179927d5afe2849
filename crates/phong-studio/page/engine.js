// The way to an engine: a server's, over a socket, or one that runs in a worker of this page.
// Both take requests and give replies and frames, as PROTOCOL.md says.

import { frames } from "./frame.js";
import { work } from "./workers.js";

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
  socket.onmessage = ({ data }) => {
    if (typeof data === "string") return hear(JSON.parse(data));
    for (const frame of frames(data)) take(frame);
  };
  socket.onclose = gone;
  return {
    send(request) {
      if (socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(request));
    },
    close() {
      socket.onclose = null;
      socket.close();
    },
  };
}
