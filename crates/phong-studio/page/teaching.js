// Find the mistake, class sheets, and pictures that are dropped on the page to be graded.

import { element, number } from "./elements.js";
import { words } from "./words.js";

export class Teaching {
  constructor(root, { send, begin }) {
    this.root = root;
    this.send = send;
    this.begin = begin;
    this.sheetRoot = element("div", {});
    this.riddle = element("div", {});
    this.graded = element("div", { role: "status", "aria-label": words.verdict });
    const find = element("button", { type: "button", id: "find" }, words.find);
    find.onclick = () => this.plant(crypto.getRandomValues(new Uint32Array(1))[0]);
    const file = element("input", { type: "file", id: "grade-file", accept: ".png,.ppm,.jpg,.jpeg,.pfm,.exr" });
    file.onchange = () => file.files[0] && this.grade(file.files[0]);
    const label = element("label", {}, element("span", {}, words.grade), " ", file);
    root.append(this.sheetRoot, find, this.riddle, label, this.graded);
  }

  plant(seed) {
    this.send({ do: "mistake", seed });
  }

  // A picture with a mistake is shown.
  choose({ choices }) {
    this.shown = true;
    this.verdict = element("p", { role: "status", class: "verdict" }, words.findHelp);
    const list = choices.map(({ cause, says }) => {
      const button = element("button", { type: "button" }, cause);
      button.dataset.cause = cause;
      button.onclick = () => this.send({ do: "guess", cause });
      return element("li", {}, button, ` ${says}`);
    });
    const give = element("button", { type: "button" }, words.giveUp);
    give.onclick = () => this.send({ do: "guess", cause: null });
    const show = element("button", { type: "button", id: "show-right" }, words.showRight);
    show.onclick = () => {
      this.end();
      this.send({ do: "resume" });
    };
    this.riddle.replaceChildren(this.verdict, element("ul", { class: "choices" }, ...list), give, " ", show);
  }

  judged({ cause, right, says }) {
    const before = cause === null ? words.gaveUp : right ? words.found : words.notFound;
    this.verdict.replaceChildren(says ? `${before} ${says}` : before);
    this.verdict.classList.toggle("right", right);
    for (const button of this.riddle.querySelectorAll("[data-cause]")) {
      if (button.dataset.cause === cause) button.setAttribute("aria-pressed", "true");
    }
  }

  // The picture with the mistake is gone.
  end() {
    if (!this.shown) return;
    this.shown = false;
    this.riddle.replaceChildren();
  }

  sheet({ title, exercises }) {
    const items = exercises.map((exercise) => {
      const button = element("button", { type: "button" }, words.begin);
      button.onclick = () => this.begin(exercise);
      return element("li", {}, element("b", {}, exercise.title), ` ${exercise.text} `, button);
    });
    this.sheetRoot.replaceChildren(element("h3", {}, title), element("ol", {}, ...items));
    this.root.parentElement.open = true;
  }

  async grade(file) {
    this.root.parentElement.open = true;
    // A base 64 text is a third longer, and a message has at most 8 MiB.
    if (file.size > 6e6) return this.graded.replaceChildren(words.tooLarge(file.name));
    this.graded.replaceChildren(words.grading(file.name));
    const url = await new Promise((resolve) => {
      const reader = new FileReader();
      reader.onload = () => resolve(reader.result);
      reader.readAsDataURL(file);
    });
    this.send({ do: "grade", name: file.name, bytes: url.slice(url.indexOf(",") + 1) });
  }

  marked({ name, told }) {
    const pass = told.verdict === "pass";
    const parts = [element("h3", {}, `${name}: ${pass ? words.passes : words.fails}`)];
    const best = told.candidates.find(({ cause }) => cause === told.cause);
    if (told.cause) parts.push(element("p", {}, element("b", {}, told.cause), best ? ` ${best.says}` : ""));
    else if (!pass) parts.push(element("p", {}, words.noCause));
    if (told.tied.length) parts.push(element("p", {}, `${words.tied} ${told.tied.join(", ")}`));
    parts.push(element("p", { class: "hint" }, `${words.rms} `, number(told.rms)));
    this.graded.replaceChildren(...parts);
  }

  refused() {
    if (this.graded.textContent) this.graded.replaceChildren();
  }
}

// A picture that is dropped anywhere on the page is graded.
export function drops(teaching) {
  addEventListener("dragover", (event) => event.preventDefault());
  addEventListener("drop", (event) => {
    event.preventDefault();
    const [file] = event.dataTransfer.files;
    if (file) teaching.grade(file);
  });
}
