// The page: it holds the film, what is shown of it, and the controls.

const el = (id) => document.getElementById(id);
const STILL = 0.8; // s that the end of an event is shown before the next one begins
const SPAN = 12; // s in which the whole film plays at the speed "1 film"

class View {
  constructor(data) {
    this.data = data;
    this.flat = data.dimension === 2;
    this.camera = new Camera(data.focus, this.flat, data.lift);
    this.painter = new Painter(el("picture"), this.flat);
    this.playing = false;
    this.at = 0; // s of the page's own time, in which pauses and all frames count
    this.section = { axis: -1, part: 1 };
    this.measures = this.pressures = true;
    for (const mesh of [...data.meshes, ...(data.pressures?.faces ?? [])]) {
      const corners = new Float32Array(bytesOfBase64(mesh.corners).buffer);
      const triangles = new Uint32Array(bytesOfBase64(mesh.triangles).buffer);
      this.painter.addMesh(corners, triangles, { ...mesh, motion: motionOf(mesh.motion) });
    }
  }

  async load() {
    const note = el("loading");
    const bytes = bytesOfBase64(el("film").textContent);
    el("film").textContent = "";
    this.film = await new Film(bytes, this.data.bounds).decode((part) => {
      note.textContent = `Unpacking the film: ${Math.round(100 * part)} %`;
    });
    note.hidden = true;
    this.timeline();
    this.choose(0);
  }

  /** Places the frames on the page's time: an event's end is shown for a while. */
  timeline() {
    const { frames } = this.film;
    this.starts = [0];
    for (let i = 1; i < frames.length; i++) {
      const turn = frames[i].event !== frames[i - 1].event;
      this.starts.push(this.starts[i - 1] + (turn ? 0 : Math.max(0, frames[i].time - frames[i - 1].time)));
    }
    const total = this.starts[frames.length - 1] || 1;
    this.rates = speeds(total);
    const hold = STILL * this.rates.usual; // of the page's time
    for (let i = 1, sum = 0; i < frames.length; i++) {
      if (frames[i].event !== frames[i - 1].event) sum += hold;
      this.starts[i] += sum;
    }
    this.length = this.starts[frames.length - 1] || 1e-9;
    const list = el("speed");
    for (const rate of this.rates.all) list.append(new Option(speedText(rate), rate, rate === this.rates.usual, rate === this.rates.usual));
    this.rate = this.rates.usual;
    el("scrub").max = frames.length - 1;
  }

  /** Returns the frame shown and how far the picture is on the way to the next. */
  place() {
    const { starts } = this;
    let low = 0, high = starts.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (starts[middle] <= this.at) low = middle;
      else high = middle - 1;
    }
    const frames = this.film.frames;
    if (low === starts.length - 1) return { index: low, part: 0 };
    const held = frames[low + 1].event !== frames[low].event;
    return { index: low, part: held ? 0 : (this.at - starts[low]) / Math.max(starts[low + 1] - starts[low], 1e-12) };
  }

  /** Chooses the colours. */
  choose(number) {
    this.colouring = this.data.colourings[number];
    const { name, low, high } = this.colouring;
    const quantity = this.film.header.quantities.findIndex((q) => q.name === name);
    this.codesOf = quantity >= 0 ? (frame) => frame.codes[quantity]
      : (frame) => (frame.numbers ??= {})[name] ??= Int16Array.from(name === "event" ? frame.events : frame.materials);
    this.step = quantity >= 0 ? this.film.header.quantities[quantity].step : 0;
    this.range = [low, high];
    this.held = null;
    this.dress();
  }

  /** Takes up the colours that suit the page, light or dark. */
  dress() {
    const colours = bytesOfBase64(this.colouring.colours[isDark() ? "dark" : "light"]);
    this.painter.setColours(colours);
    drawLegend(this.colouring, colours);
    if (this.pressures && this.data.pressures) addSwatches(this.data.pressures);
    this.render();
  }

  /** Hands a pair of frames to the painter, particle by particle. */
  hold(index) {
    if (this.held === index) return;
    this.held = index;
    const { frames } = this.film;
    const from = frames[index];
    const next = frames[Math.min(index + 1, frames.length - 1)];
    const to = next.event === from.event ? next : from;
    const [places, codes] = aligned(from, to, this.codesOf);
    this.painter.setParticles(from.positions, places, this.codesOf(from), codes, radiiOf(from, this.film.header));
  }

  render() {
    if (!this.film) return;
    const { index, part } = this.place();
    this.hold(index);
    const { frames } = this.film, frame = frames[index];
    const next = frames[Math.min(index + 1, frames.length - 1)];
    const time = frame.time + part * (next.time - frame.time);
    this.camera.aspect = this.painter.resize();
    const view = this.camera.matrix(el("picture").height);
    this.painter.draw(view, {
      ...look(), part, time, low: this.film.low, size: this.film.size, radius: this.data.radius,
      range: this.range, step: this.step, section: this.plane(), pressed: this.pressures ? frame.event : 0,
    });
    this.tell(frame, index, time);
    drawMeasures(this, view, frame, index);
  }

  /** Returns the plane beyond which nothing is drawn. */
  plane() {
    const { axis, part } = this.section, { low, high } = this.data.focus;
    if (axis < 0) return [0, 0, 0, 1];
    const normal = [0, 0, 0];
    normal[axis] = axis === 1 ? -1 : 1; // the near half goes, seen from the front
    const value = low[axis] + (axis === 1 ? 1 - part : part) * (high[axis] - low[axis]);
    return [...normal, normal[axis] * value];
  }

  tell(frame, index, time) {
    const first = this.film.frames.findIndex((one) => one.event === frame.event);
    const start = this.film.frames[first].time;
    const text = `event ${frame.event} of ${this.data.events}, ${secondsText(time - start)}`;
    const whole = this.data.events > 1 ? text : secondsText(time - start);
    if (el("clock").textContent !== whole) el("clock").textContent = whole;
    el("scrub").value = index;
    el("scrub").setAttribute("aria-valuetext", text);
  }

  go(index) {
    const last = this.film.frames.length - 1;
    this.at = this.starts[Math.max(0, Math.min(last, index))];
    this.render();
  }

  play(on) {
    if (!this.film) return;
    if (on && this.at >= this.length) this.at = 0;
    this.playing = on;
    el("play").textContent = on ? "Pause" : "Play";
    el("play").setAttribute("aria-pressed", String(on));
    this.before = performance.now();
    if (on) requestAnimationFrame((now) => this.tick(now));
  }

  tick(now) {
    if (!this.playing) return;
    this.at += Math.min(0.1, Math.max(0, (now - this.before) / 1000)) * this.rate;
    this.before = now;
    if (this.at >= this.length) {
      this.at = this.length;
      this.play(false);
    } else requestAnimationFrame((next) => this.tick(next));
    this.render();
  }
}

/** Returns speeds that suit a film of so many seconds: seconds of snow in a second of the viewer. */
function speeds(total) {
  const usual = total > 3 && total < 30 ? 1 : roundDown(total / SPAN);
  const all = [0.1, 0.25, 0.5, 1, 2, 4].map((factor) => Number((factor * usual).toPrecision(3)));
  return { usual, all };
}

function roundDown(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return Number(([5, 2, 1].find((m) => m * power <= value * 1.0001) * power).toPrecision(3));
}

function speedText(rate) {
  if (rate === 1) return "real time";
  return rate > 1 ? `${rate} × faster` : `${Number((1 / rate).toPrecision(3)).toLocaleString("en")} × slower`;
}

function secondsText(time) {
  if (time >= 0.995 || time === 0) return `${time.toFixed(2)} s`;
  if (time >= 1e-2) return `${time.toFixed(3)} s`;
  return time >= 1e-4 ? `${(1e3 * time).toFixed(2)} ms` : `${(1e6 * time).toFixed(1)} µs`;
}

/** Returns the places and codes of the particles of `from` in `to`; of lost ones, their own. */
function aligned(from, to, codesOf) {
  if (from.ids === to.ids) return [to.positions, codesOf(to)];
  const among = indicesIn(from.ids, to.ids);
  const places = from.positions.slice(), codes = codesOf(from).slice(), theirs = codesOf(to);
  for (let i = 0; i < among.length; i++) {
    const k = among[i];
    if (k < 0) continue;
    codes[i] = theirs[k];
    for (let axis = 0; axis < 3; axis++) places[3 * i + axis] = to.positions[3 * k + axis];
  }
  return [places, codes];
}

function radiiOf(frame, header) {
  if (!frame.radii) return null;
  return (frame.metres ??= Float32Array.from(frame.radii, (r) => r * header.quantum_m));
}

/** Returns the pose over time of a solid that moves: a matrix of four columns. */
function motionOf(spec) {
  if (!spec) return null;
  const spin = Math.hypot(...spec.angular_velocity), axis = spec.angular_velocity.map((x) => x / (spin || 1));
  return (time) => {
    const elapsed = Math.max(0, Math.min(time, spec.end) - spec.start);
    const [x, y, z] = axis, c = Math.cos(spin * elapsed), s = Math.sin(spin * elapsed), d = 1 - c;
    const m = [
      c + x * x * d, y * x * d + z * s, z * x * d - y * s, 0,
      x * y * d - z * s, c + y * y * d, z * y * d + x * s, 0,
      x * z * d + y * s, y * z * d - x * s, c + z * z * d, 0, 0, 0, 0, 1,
    ];
    const p = spec.pivot;
    for (let k = 0; k < 3; k++)
      m[12 + k] = p[k] + elapsed * spec.velocity[k] - (m[k] * p[0] + m[4 + k] * p[1] + m[8 + k] * p[2]);
    return new Float32Array(m);
  };
}

async function begin() {
  const data = JSON.parse(el("data").textContent);
  let view;
  try {
    if (!("DecompressionStream" in window)) throw new Error("no DecompressionStream");
    view = new View(data);
  } catch (error) {
    document.body.classList.add("still");
    el("why").textContent = `This browser cannot show the moving view (${error.message}).`;
    return;
  }
  document.body.classList.add("moving");
  listen(view);
  await view.load();
  if (!matchMedia("(prefers-reduced-motion: reduce)").matches) view.play(true);
  else view.go(view.film.frames.length - 1);
  document.body.dataset.ready = "true";
}

begin();
