// Files: what comes from the engine is kept in a file or copied, as was asked for.

export class Saving {
  constructor(send, said) {
    this.send = send;
    this.said = said;
    this.asked = []; // what each file that is to come is for
  }

  download(format) {
    this.ask(format, (name, bytes) => {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(new Blob([bytes]));
      link.download = name;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    });
  }

  copy(format) {
    this.ask(format, (_, bytes) => this.clip(new TextDecoder().decode(bytes)));
  }

  async clip(text) {
    await navigator.clipboard.writeText(text);
    this.said();
  }

  ask(format, use) {
    this.asked.push(use);
    this.send({ do: "export", format });
  }

  named(name) {
    this.name = name;
  }

  take(bytes) {
    this.asked.shift()?.(this.name, bytes);
  }

  // A file does not come.
  refused() {
    this.asked.length = 0;
  }
}
