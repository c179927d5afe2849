// The scene's text, what there is to say about it, and what can be written at the caret.

import { complete } from "./completion.js";
import { words } from "./words.js";

// How long after the last letter the text is read, milliseconds.
const PAUSE = 200;

export class Editor {
  constructor(area, list, offers, edit) {
    this.area = area;
    this.list = list;
    this.offers = offers;
    this.edit = edit;
    this.waiting = 0;
    this.chosen = -1;
    this.shown = { text: "", value: "" }; // what was shown last, and what the text area made of it
    area.addEventListener("input", () => {
      clearTimeout(this.waiting);
      this.waiting = setTimeout(() => this.flush(), PAUSE);
      this.offer(false);
    });
    area.addEventListener("keydown", (event) => this.key(event));
    area.addEventListener("blur", () => this.close());
    area.addEventListener("click", () => this.close());
    // Tab leaves the text, as everywhere else; two blanks are typed as two blanks.
  }

  // The text as its file has it. A text area has "\n" at the end of each line, whatever stood there: what was
  // shown and not changed is the very text; what was changed has the line ends of what was shown.
  get text() {
    const { value } = this.area;
    if (value === this.shown.value) return this.shown.text;
    return this.shown.text.includes("\r\n") ? value.replaceAll("\n", "\r\n") : value;
  }

  keys(schema) {
    this.schema = schema;
  }

  // What was typed is sent at once; whether there was anything.
  flush() {
    if (!this.waiting) return false;
    clearTimeout(this.waiting);
    this.waiting = 0;
    this.edit(this.text);
    return true;
  }

  show(text) {
    clearTimeout(this.waiting);
    this.waiting = 0;
    this.area.disabled = text === null;
    const value = (text ?? "").replace(/\r\n?/g, "\n");
    this.shown = { text: text ?? "", value };
    if (this.area.value === value) return;
    const { scrollTop, selectionStart, selectionEnd } = this.area;
    this.area.value = value;
    this.area.scrollTop = scrollTop;
    this.area.setSelectionRange(selectionStart, selectionEnd);
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

  // Offers what can be written at the caret.
  offer(asked) {
    const { selectionStart: caret, selectionEnd: end, value } = this.area;
    const found = this.schema && caret === end ? complete(this.schema, value, caret) : null;
    if (!found || (!asked && found.from === caret && !/[=[]\s*$/.test(value.slice(0, caret)))) return this.close();
    this.found = found;
    this.chosen = -1;
    const items = found.offers.map(({ text, means }, i) => {
      const item = document.createElement("li");
      item.id = `offer${i}`;
      item.setAttribute("role", "option");
      item.setAttribute("aria-selected", "false");
      const name = document.createElement("b");
      name.textContent = text;
      item.append(name, ` ${means}`);
      item.addEventListener("pointerdown", (event) => {
        event.preventDefault();
        this.take(i);
      });
      return item;
    });
    this.offers.replaceChildren(...items);
    const above = value.slice(0, found.from).split("\n");
    this.offers.style.setProperty("--line", above.length);
    this.offers.style.setProperty("--column", above.at(-1).length);
    this.offers.style.setProperty("--scrolled", `${this.area.scrollTop}px`);
    this.offers.hidden = false;
    this.area.setAttribute("aria-expanded", "true");
  }

  close() {
    this.offers.hidden = true;
    this.area.setAttribute("aria-expanded", "false");
    this.area.removeAttribute("aria-activedescendant");
  }

  choose(i) {
    const all = [...this.offers.children];
    this.chosen = (i + all.length) % all.length;
    all.forEach((item, place) => item.setAttribute("aria-selected", String(place === this.chosen)));
    this.area.setAttribute("aria-activedescendant", `offer${this.chosen}`);
    all[this.chosen].scrollIntoView({ block: "nearest" });
  }

  take(i) {
    const { text } = this.found.offers[i];
    this.area.setRangeText(text, this.found.from, this.area.selectionStart, "end");
    this.close();
    this.area.dispatchEvent(new Event("input"));
    this.close();
  }

  key(event) {
    if (event.key === " " && event.ctrlKey) {
      event.preventDefault();
      return this.offer(true);
    }
    if (this.offers.hidden) return;
    const { key } = event;
    if (key === "ArrowDown") this.choose(this.chosen + 1);
    else if (key === "ArrowUp") this.choose(Math.max(this.chosen, 0) - 1);
    else if (key === "Enter" && this.chosen >= 0) this.take(this.chosen);
    else if (key === "Escape") this.close();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }
}
