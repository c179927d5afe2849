// The scene's text, and what there is to say about it.

import { words } from "./words.js";

export class Editor {
  constructor(area, list, edit) {
    this.area = area;
    this.list = list;
    let waiting = 0;
    area.addEventListener("input", () => {
      clearTimeout(waiting);
      waiting = setTimeout(() => edit(area.value), 200);
    });
    // Tab leaves the text, as everywhere else; two blanks are typed as two blanks.
  }

  show(text) {
    this.area.value = text ?? "";
    this.area.disabled = text === null;
  }

  say(diagnostics) {
    const items = diagnostics.map(({ severity, message, help, line, column }) => {
      const item = document.createElement("li");
      item.className = severity;
      const place = document.createElement("button");
      place.type = "button";
      place.textContent = line ? `${words.line} ${line}` : severity;
      place.onclick = () => this.go(line ?? 1, column ?? 1);
      item.append(place, ` ${message}${help ? ` (${help})` : ""}`);
      return item;
    });
    this.list.replaceChildren(...items);
    this.area.setAttribute("aria-invalid", String(diagnostics.some(({ severity }) => severity === "error")));
  }

  // Puts the caret at a line and a column; columns count characters, the text area counts UTF-16.
  go(line, column) {
    const lines = this.area.value.split("\n");
    const before = lines.slice(0, line - 1).reduce((sum, one) => sum + one.length + 1, 0);
    const place = before + [...(lines[line - 1] ?? "")].slice(0, column - 1).join("").length;
    this.area.focus();
    this.area.setSelectionRange(place, place);
  }
}
