// The file that is open: whether its text is saved, and what somebody else has made of it meanwhile.

import { element } from "./elements.js";
import { words } from "./words.js";

// How often the file is looked at while the page is seen, milliseconds.
const OFTEN = 4000;

export class OpenFile {
  // `send` asks the engine, `text` gives the text as it is, `said` says something; without a folder to save
  // in, `download` keeps the text.
  constructor({ send, text, said, download }) {
    Object.assign(this, { send, text, said, download });
    this.button = document.getElementById("save-file");
    this.mark = document.getElementById("unsaved");
    this.hint = document.getElementById("once-saved");
    this.notice = document.getElementById("changed");
    this.saves = false;
    this.start(null, null);
    this.button.onclick = () => this.save();
    const look = () => this.saves && this.kept !== null && !document.hidden && this.send({ do: "check-file" });
    addEventListener("focus", look);
    document.addEventListener("visibilitychange", look);
    setInterval(look, OFTEN);
    addEventListener("beforeunload", (event) => this.unsaved && event.preventDefault());
  }

  begin(saves) {
    this.saves = saves;
    this.button.hidden = !saves;
  }

  // Another file is open, with this text; `null`: it has none.
  start(path, text) {
    this.path = path;
    this.kept = text;
    this.show();
    this.settled();
  }

  get unsaved() {
    return this.kept !== null && this.text() !== this.kept;
  }

  // Marks whether there is something to save.
  show() {
    const unsaved = this.unsaved;
    this.mark.hidden = this.hint.hidden = !unsaved;
    this.button.disabled = !unsaved;
    document.title = `${unsaved ? "• " : ""}${this.path ? `${this.path} – ` : ""}${words.title}`;
  }

  // Whether another file may be opened: what is not saved would be lost.
  mayLeave() {
    return !this.unsaved || confirm(words.leaveUnsaved(this.path));
  }

  save(over = false) {
    if (!this.saves) return this.download();
    if (this.kept === null) return;
    this.sent = this.text();
    this.asked = true;
    this.send({ do: "save", over, text: this.sent });
  }

  // The engine has saved what it was sent.
  saved() {
    this.kept = this.sent;
    this.settled();
    this.show();
    this.said(words.saved(this.path));
  }

  // The engine has taken this text from the file.
  taken(text) {
    this.kept = text;
    this.settled();
    this.show();
  }

  // Somebody else has changed the file.
  changed({ gone }) {
    if (this.ignored && !this.asked) return;
    this.asked = false;
    const button = (word, act) => {
      const made = element("button", { type: "button" }, word);
      made.onclick = act;
      return made;
    };
    const said = element("span", {}, (gone ? words.fileGone : words.fileChanged)(this.path));
    const take = button(words.takeFile, () => this.send({ do: "take-file" }));
    const over = button(words.saveOver, () => this.save(true));
    const later = button(words.later, () => {
      this.settled();
      this.ignored = true;
    });
    if (!this.notice.hidden && this.gone === gone) return;
    this.gone = gone;
    this.notice.replaceChildren(said, ...(gone ? [] : [take]), over, later);
    this.notice.hidden = false;
  }

  // There is nothing to decide any more.
  settled() {
    this.notice.hidden = true;
    this.notice.replaceChildren();
    this.ignored = false;
    this.asked = false;
  }
}
