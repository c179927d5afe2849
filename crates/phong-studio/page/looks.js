// The menu of looks: a look that is pointed at, or reached by a key, is shown at once, and put on when it is chosen.

import { element } from "./elements.js";
import { words } from "./words.js";

export class Looks {
  // `tryOn` shows a look, `null` what is there without; `putOn` keeps one.
  constructor(button, list, { tryOn, putOn }) {
    Object.assign(this, { button, list, tryOn, putOn });
    this.tried = null;
    button.onclick = () => (list.hidden ? this.open() : this.close());
    button.addEventListener("keydown", (event) => {
      if (event.key === "ArrowDown" || event.key === "ArrowUp") this.open();
      else return;
      event.preventDefault();
    });
    list.addEventListener("keydown", (event) => this.key(event));
    // The focus stays in the menu while a pointer is pressed on it.
    list.addEventListener("pointerdown", (event) => event.preventDefault());
    list.addEventListener("focusout", ({ relatedTarget }) => {
      if (!list.contains(relatedTarget) && relatedTarget !== button) this.close();
    });
  }

  // What there is to choose from.
  names(names) {
    const item = (name) => {
      const made = element("button", { type: "button", role: "menuitemradio", tabindex: -1 }, name || words.chooseLook);
      made.dataset.look = name;
      made.onclick = () => this.choose(name);
      made.onfocus = () => this.show(name);
      made.onpointerenter = ({ pointerType }) => pointerType !== "touch" && made.focus();
      return element("li", { role: "none" }, made);
    };
    this.list.replaceChildren(...["", ...names].map(item));
    this.now(null);
  }

  // The look that is on; `null`: none that is known.
  now(name) {
    this.name = name ?? "";
    this.button.lastElementChild.textContent = name || words.chooseLook;
    for (const item of this.items) item.setAttribute("aria-checked", String(item.dataset.look === this.name));
  }

  get items() {
    return [...this.list.querySelectorAll("button")];
  }

  open() {
    this.list.hidden = false;
    this.button.setAttribute("aria-expanded", "true");
    this.items.find((item) => item.dataset.look === this.name)?.focus();
  }

  // Without a choice, what was shown goes.
  close(chosen = false) {
    if (this.list.hidden) return;
    const inside = this.list.contains(document.activeElement);
    this.list.hidden = true;
    this.button.setAttribute("aria-expanded", "false");
    if (inside) this.button.focus();
    if (this.tried && !chosen) this.tryOn(null);
    this.tried = null;
  }

  show(name) {
    const wanted = name === this.name ? null : name || null;
    if (wanted === this.tried) return;
    this.tried = wanted;
    this.tryOn(wanted);
  }

  choose(name) {
    this.close(true);
    this.putOn(name);
  }

  key(event) {
    const items = this.items;
    const place = items.indexOf(document.activeElement);
    const last = items.length - 1;
    const ways = { ArrowDown: place === last ? 0 : place + 1, ArrowUp: place > 0 ? place - 1 : last, Home: 0, End: last };
    if (event.key in ways) items[ways[event.key]].focus();
    else if (event.key === "Escape") this.close();
    else return;
    event.preventDefault();
  }
}
