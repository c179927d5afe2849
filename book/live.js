// Makes the book's figures live: in each `div.live` a picture is drawn by the renderer as WebAssembly, to
// be turned, changed and asked. Without it, or without a script, the text and the still figures stay.
//
// data-scene    the scene, below studio/scenes
// data-begin    values laid over it at first: `{"materials.ball.model": "blinn-phong"}`
// data-sliders  keys, each with its ends and its default: `materials.ball.shininess 1 200 32, light.1.position.0 -6 6`
// data-pixel    the pixel that is explained at first
// data-check    what the task asks for: `at PATH VALUE TOLERANCE` of the explained pixel,
//               `width TERM RATIO TOLERANCE` of the width at half the peak, against the scene as it is, or
//               `error MOST` of the counted facets, or `half DEGREES TOLERANCE` of the half width of a curve
// data-mistake  a known mistake, and after it what its box is called: the picture is drawn with it
// data-facets   instead of a scene: the most facets that are drawn
// data-power    instead of a scene: the largest exponent of a curve of cos^i

(() => {
  const figures = [...document.querySelectorAll("div.live")];
  if (figures.length === 0) return;
  const words = {
    help: "Drag the picture to move your head; click a point to ask for its numbers.",
    numbers: "The numbers of this point",
    check: "Check",
    picture: "A live picture. Arrow keys turn it, plus and minus bring it nearer; click a point to ask for its numbers.",
    yes: (said) => `Yes: ${said}.`,
    no: (said) => `Not yet: ${said}.`,
    value: (name, value, wanted) => `${name} is ${value}, and ${wanted} is asked for`,
    of: (part, whole) => `${part} of ${whole}`,
    colors: ["red", "green", "blue"],
    sum: "the sum",
    nothing: "the ray through this pixel has no such number: click a point of the ball",
    width: (now, before) => `it is ${now} pixels wide at half its peak, and was ${before}`,
    facets: (count, error) => `with ${count} facets the error is ${error} of the peak`,
    power: (exponent, half) => `cos to the power ${exponent} is down to half its peak at ${half}°`,
    exponent: "exponent i",
    count: "facets",
    again: "Draw as many facets",
  };
  const base = new URL(`${typeof path_to_root === "string" ? path_to_root : ""}studio/`, document.baseURI);
  const make = (name, attributes = {}, ...children) => {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.append(...children);
    return made;
  };
  const short = (value) => String(Number(value.toPrecision(3)));

  // The one engine of the page, and the figure that has it.
  const stage = {
    engine: null,
    holder: null,
    checking: false,
    asked: 0,
    waiting: new Map(),
    async start() {
      const load = (name) => import(new URL(name, base).href);
      const names = ["workers.js", "picture.js", "hands.js", "explained.js"];
      const [{ work }, { Picture }, { Hands }, { show }] = await Promise.all(names.map(load));
      Object.assign(this, { Picture, Hands, show });
      this.engine = work({ hear: (reply) => this.hear(reply), take: (frame) => this.holder?.tile(frame) });
    },
    hear(reply) {
      const waits = this.waiting.get(reply.id);
      if (waits) {
        this.waiting.delete(reply.id);
        return waits.resolve(reply);
      }
      if (reply.is === "hello") return figures.forEach((root) => seen.observe(root));
      if (reply.is === "error") {
        this.waiting.forEach(({ reject }) => reject(new Error(reply.message)));
        this.waiting.clear();
      }
      this.holder?.hear(reply);
    },
    // Whether nobody needs the engine: the picture of who has it is done, and no task is looked at.
    rests() {
      return !this.checking && (!this.holder || this.holder.root.dataset.done === String(this.holder.look?.picture));
    },
    // Asks a question, and waits for its answer.
    ask(request) {
      this.asked += 1;
      const id = this.asked;
      this.engine.send({ ...request, id });
      return new Promise((resolve, reject) => this.waiting.set(id, { resolve, reject }));
    },
  };
  // For who looks from outside, as tests do.
  globalThis.lecture = stage;

  class Live {
    constructor(root) {
      this.root = root;
      this.set = JSON.parse(root.dataset.begin ?? "{}");
      this.pixel = (root.dataset.pixel ?? "").split(" ").map(Number);
      this.canvas = make("canvas", { width: 1, height: 1 });
      this.overlay = document.createElementNS("http://www.w3.org/2000/svg", "svg");
      this.overlay.setAttribute("aria-hidden", "true");
      this.frame = make("div", { class: "live-frame", tabindex: 0, role: "application", "aria-label": words.picture });
      this.frame.append(this.canvas, this.overlay);
      this.why = make("div");
      this.numbers = make("details", {}, make("summary", {}, words.numbers), this.why);
      const sliders = (root.dataset.sliders ?? "").split(",").filter((one) => one.trim());
      this.refresh = [];
      const rows = sliders.map((one) => this.slider(...one.trim().split(" ")));
      if (root.dataset.mistake) rows.push(this.mistake(...root.dataset.mistake.split(/ (.*)/)));
      root.prepend(this.frame, make("p", { class: "live-help" }, words.help), ...rows, this.numbers);
      checked(this);
      const send = (request) => this.hold() && stage.engine.send(request);
      this.hands = new stage.Hands(send);
      const pin = (pixel) => this.explain(pixel);
      this.picture = new stage.Picture(this.frame, this.hands, { point: () => {}, pin });
      this.frame.addEventListener("pointerdown", () => this.hold());
      this.frame.addEventListener("focus", () => this.hold());
    }

    // Takes the engine for this figure.
    hold() {
      if (stage.holder === this) return true;
      stage.holder = this;
      stage.engine.send({ do: "open", path: `${this.root.dataset.scene}.toml` });
      // The first look is of the scene as its text has it.
      this.fresh = Object.keys(this.set).length > 0;
      if (this.fresh) stage.engine.send({ do: "look", set: this.set });
      return true;
    }

    // A box that draws the picture with a known mistake; what changes the picture takes it out.
    mistake(cause, name) {
      const box = make("input", { type: "checkbox", "aria-label": name });
      box.onchange = () => {
        this.hold();
        stage.engine.send(box.checked ? { do: "mistake", cause } : { do: "look", set: {} });
      };
      this.wrong = (on) => (box.checked = on);
      return make("label", { class: "live-box" }, box, ` ${name}`);
    }

    // `start` is the key's default: of what is as by default nothing is told.
    slider(path, least, most, start) {
      const input = make("input", { type: "range", min: least, max: most, step: "any", "aria-label": path });
      const output = make("output");
      input.oninput = () => {
        this.hold();
        const value = Number(Number(input.value).toPrecision(3));
        output.textContent = short(value);
        const place = path.match(/^(.*)\.(\d)$/);
        const whole = place && Array.isArray(valueOf(this.look.values, place[1]));
        if (!whole) return this.hands.look({ [path]: value });
        const values = [...valueOf(this.look.values, place[1])];
        values[place[2]] = value;
        this.hands.look({ [place[1]]: values });
      };
      this.refresh.push((values) => {
        const value = valueOf(values, path) ?? Number(start);
        if (Number.isNaN(value) || document.activeElement === input) return;
        input.value = value;
        output.textContent = short(value);
      });
      const [first, second, ...rest] = path.split(".");
      const name = first === "light" ? `lamp ${"xyz"[rest.at(-1)]}` : `${rest.at(-1)} (${second})`;
      return make("label", { class: "live-slider" }, name, input, output);
    }

    hear(reply) {
      if (reply.is === "look") {
        if (this.fresh) return (this.fresh = false);
        this.look = reply;
        this.set = reply.set;
        this.picture.begin(reply.picture, reply.size);
        this.wrong?.(false);
        this.refresh.forEach((refresh) => refresh(reply.values));
        if (this.pixel.length === 2) this.explain(this.pixel);
      }
      if (reply.is === "mistake") this.wrong?.(true);
      if (reply.is === "pass" && reply.pass === 0) {
        // Where there is one pass alone, its tiles are of full size.
        if (reply.passes > 1) this.picture.first();
        this.hands.seen();
      }
      if (reply.is === "pass" && reply.pass + 1 === reply.passes) this.root.dataset.done = reply.picture;
      if (reply.is === "error") this.why.textContent = reply.message;
    }

    tile(frame) {
      if (this.look?.picture === frame.picture) this.picture.tile(frame);
    }

    async explain(pixel) {
      this.pixel = pixel;
      if (this.asking) return (this.next = pixel);
      this.asking = true;
      this.hold();
      try {
        const { told, lines } = await stage.ask({ do: "explain", pixel });
        this.root.dataset.told = told.pixel.join(" ");
        this.picture.lines(lines, told.pixel);
        stage.show(this.why, told);
      } catch (error) {
        this.why.textContent = error.message;
      }
      this.asking = false;
      const next = this.next;
      this.next = null;
      if (next) this.explain(next);
    }

    // How many pixels of a row through the explained one have at least half of the row's peak.
    async width(term) {
      const [across] = this.look.size;
      const row = Array.from({ length: across }, (_, x) => stage.ask({ do: "explain", pixel: [x, this.pixel[1]] }));
      const values = (await Promise.all(row)).map(({ told }) => told.terms[term][0]);
      const half = Math.max(...values) / 2;
      return values.filter((value) => half > 0 && value >= half).length;
    }

    async check(kind, ...parts) {
      this.hold();
      if (kind === "at") {
        const [path, wanted, tolerance] = [parts[0], Number(parts[1]), Number(parts[2])];
        this.hands.flush();
        const { told } = await stage.ask({ do: "explain", pixel: this.pixel });
        const value = read(told, path);
        if (typeof value !== "number") return [false, words.nothing];
        return [Math.abs(value - wanted) <= tolerance, words.value(named(path), short(value), wanted)];
      }
      const [term, ratio, tolerance] = [parts[0], Number(parts[1]), Number(parts[2])];
      const mine = this.set;
      if (this.before === undefined) {
        const view = Object.fromEntries(Object.entries(mine).filter(([key]) => key.startsWith("camera.")));
        await this.lay(view);
        this.before = await this.width(term);
        await this.lay(mine);
      }
      const now = await this.width(term);
      const good = Math.abs(now - ratio * this.before) <= tolerance * this.before;
      return [good, words.width(now, this.before)];
    }

    // Lays these values over the scene, and no others.
    async lay(set) {
      stage.engine.send({ do: "reset" });
      stage.engine.send({ do: "look", set });
    }
  }

  // Facets are drawn at random, and where they send the light is counted beside the lobe.
  class Facets {
    constructor(root) {
      this.root = root;
      this.plot = plot();
      const most = Math.log10(Number(root.dataset.facets));
      const input = make("input", { type: "range", min: 0, max: most, step: 0.02, value: 0, "aria-label": words.count });
      const output = make("output");
      this.theta = 55;
      this.count = 1;
      input.oninput = () => {
        this.count = Math.round(10 ** Number(input.value));
        output.textContent = this.count;
        this.draw();
      };
      output.textContent = this.count;
      root.prepend(this.plot, make("label", { class: "live-slider" }, words.count, input, output));
      checked(this);
    }

    hold() {
      if (!this.told) this.draw();
    }

    // Draws as many facets as are asked for; while one answer is waited for, the newest wish is kept.
    draw() {
      this.drawing ??= this.drawn().finally(() => (this.drawing = null));
      return this.drawing;
    }

    async drawn() {
      do {
        this.told = await stage.ask({ do: "facets", theta: this.theta, count: this.count });
        this.show(this.told);
      } while (this.told.count !== this.count);
    }

    show({ counted, lobe, count, error }) {
      const [width, height, top] = [480, 190, 1.3 * Math.max(...lobe)];
      const y = (value) => height - (height * Math.min(value, top)) / top;
      const each = width / counted.length;
      const bars = counted.map((value, i) =>
        part("rect", { class: "bar", x: i * each + 1, y: y(value), width: each - 2, height: height - y(value) }),
      );
      const points = lobe.map((value, i) => `${(i * width) / (lobe.length - 1)},${y(value)}`).join(" ");
      this.plot.replaceChildren(...bars, part("polyline", { class: "lobe", points }));
      this.plot.setAttribute("aria-label", words.facets(count, short(error)));
      this.root.dataset.done = count;
    }

    async check(_, most) {
      await this.draw();
      return [this.told.error <= Number(most), words.facets(this.told.count, short(this.told.error))];
    }
  }

  // How a highlight falls off, by its exponent.
  class Power {
    constructor(root) {
      this.root = root;
      this.plot = plot();
      const most = Math.log10(Number(root.dataset.power));
      const input = make("input", { type: "range", min: 0, max: most, step: 0.005, value: 0, "aria-label": words.exponent });
      const output = make("output");
      this.exponent = 1;
      input.oninput = () => {
        this.exponent = Number((10 ** Number(input.value)).toPrecision(3));
        output.textContent = this.exponent;
        this.draw();
      };
      output.textContent = this.exponent;
      root.prepend(this.plot, make("label", { class: "live-slider" }, words.exponent, input, output));
      checked(this);
    }

    hold() {
      if (!this.told) this.draw();
    }

    draw() {
      this.drawing ??= this.drawn().finally(() => (this.drawing = null));
      return this.drawing;
    }

    async drawn() {
      do {
        this.told = await stage.ask({ do: "cosine-power", exponent: this.exponent });
        this.show(this.told);
      } while (this.told.exponent !== this.exponent);
    }

    // The curve, and where half of its peak is left.
    show({ curve, range, exponent, half_width: half }) {
      const [width, height] = [480, 190];
      const x = (degrees) => ((degrees - range[0]) / (range[1] - range[0])) * width;
      const y = (share) => height * (1 - share) + 5;
      const points = curve.map((share, i) => `${(i * width) / (curve.length - 1)},${y(share)}`).join(" ");
      const marks = [-half, half].map((at) => part("line", { class: "half", x1: x(at), y1: y(0.5), x2: x(at), y2: y(0) }));
      const across = part("line", { class: "half", x1: x(-half), y1: y(0.5), x2: x(half), y2: y(0.5) });
      this.plot.replaceChildren(part("polyline", { class: "lobe", points }), across, ...marks);
      this.plot.setAttribute("aria-label", words.power(short(exponent), short(half)));
      this.root.dataset.done = exponent;
    }

    async check(_, degrees, tolerance) {
      await this.draw();
      const { exponent, half_width: half } = this.told;
      return [Math.abs(half - Number(degrees)) <= Number(tolerance), words.power(short(exponent), short(half))];
    }
  }

  const part = (name, attributes) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    return made;
  };

  // An empty plot.
  const plot = () => part("svg", { viewBox: "0 0 480 200", class: "live-plot", role: "img" });

  // What the number is called that a path of an explanation leads to: `l · n`, `x of n`, `blue of the sum`.
  function named(path) {
    const [last, whole] = path.split(".").reverse();
    if (!/^\d$/.test(last)) return last.replaceAll("_dot_", " · ");
    if (whole.length === 1) return words.of("xyz"[last], whole);
    return words.of(words.colors[last], whole === "linear" ? words.sum : whole);
  }

  // What a path of an explanation leads to.
  function read(told, path) {
    return path.split(".").reduce((at, part) => at?.[part], told);
  }

  // What a key of the scene text leads to: its lights count from 1.
  function valueOf(values, path) {
    const walk = (at, part) => (Array.isArray(at) && typeof at[0] === "object" ? at[part - 1] : at?.[part]);
    return path.split(".").reduce(walk, values);
  }

  // The task's button, and what comes of it.
  function checked(live) {
    const { check } = live.root.dataset;
    if (!check) return;
    const button = make("button", { type: "button" }, words.check);
    const says = make("output", { class: "live-verdict", role: "status" });
    button.onclick = async () => {
      button.disabled = true;
      stage.checking = true;
      const [good, said] = await live.check(...check.split(" ")).catch((error) => [false, error.message]);
      says.textContent = good ? words.yes(said) : words.no(said);
      says.dataset.good = good;
      stage.checking = false;
      button.disabled = false;
    };
    live.root.append(make("p", { class: "live-check" }, button, " ", says));
  }

  const lives = new Map();
  // Keeps the book for when there is no network.
  const keep = () => navigator.serviceWorker?.register(new URL("../offline.js", base)).catch(() => {});
  // A figure begins when it is first seen.
  const seen = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      if (!isIntersecting) continue;
      seen.unobserve(target);
      const { facets, power } = target.dataset;
      const live = facets ? new Facets(target) : power ? new Power(target) : new Live(target);
      lives.set(target, live);
      begin(live);
    }
  });
  // One after another: the engine draws for one at a time. A figure from which another takes the engine
  // before it is done, as its reader has it, draws when that one rests.
  let turn = Promise.resolve();
  function begin(live) {
    turn = turn.then(async () => {
      for (let i = 0; i < 600 && !live.root.dataset.done; i += 1) {
        if (stage.rests()) live.hold();
        await new Promise((resolve) => setTimeout(resolve, 50));
      }
      keep();
    });
  }

  stage.start().catch(() => {});
})();
