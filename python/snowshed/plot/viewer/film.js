// Decodes a film of snowshed (docs/reference/film.md) into frames that can be drawn.

/** Returns the bytes of a base64 text. */
function bytesOfBase64(text) {
  const binary = atob(text.trim());
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

/** Returns the uncompressed bytes of a zlib stream. */
async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Reads LEB128 integers: seven bits per byte, lowest first. */
class NumberReader {
  constructor(bytes) {
    this.bytes = bytes;
    this.at = 0;
  }
  unsigned() {
    let value = 0, shift = 0, byte;
    do {
      byte = this.bytes[this.at++];
      value |= (byte & 127) << shift;
      shift += 7;
    } while (byte > 127);
    return value >>> 0;
  }
  signed() {
    const n = this.unsigned();
    return (n >>> 1) ^ -(n & 1);
  }
  /** Reads differences between neighbours, zigzag-coded, and returns their sums. */
  list(count, kind) {
    const values = new kind(count);
    for (let i = 0, before = 0; i < count; i++) values[i] = before = (before + this.signed()) | 0;
    return values;
  }
}

/** Returns the index of each id in `others` (both sorted), or -1. */
function indicesIn(ids, others) {
  const indices = new Int32Array(ids.length);
  for (let i = 0, k = 0; i < ids.length; i++) {
    while (k < others.length && others[k] < ids[i]) k++;
    indices[i] = others[k] === ids[i] ? k : -1;
  }
  return indices;
}

/**
 * The frames of a film. Each has time (s), event, ids, events, materials, radii (or null),
 * positions (Uint16, three per particle; 0 and 65535 are the bounds) and codes by quantity (Int16).
 */
class Film {
  constructor(bytes, bounds) {
    this.bytes = bytes;
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    this.low = bounds.low;
    this.size = bounds.high.map((high, k) => Math.max(high - bounds.low[k], 1e-9));
    const length = this.view.getUint32(12, true);
    this.header = JSON.parse(new TextDecoder().decode(bytes.subarray(24, 24 + length)));
    this.start = 24 + length;
    this.frames = [];
  }

  async decode(progress) {
    const { view, bytes } = this;
    let at = this.start;
    let yieldedAt = performance.now();
    while (at + 40 <= bytes.length && view.getUint32(at, true) === 0x4d415246) {
      const packed = view.getUint32(at + 32, true);
      const end = at + 40 + packed;
      if (end > bytes.length) break;
      const frame = {
        time: view.getFloat64(at + 8, true),
        event: view.getUint32(at + 16, true),
        count: view.getUint32(at + 24, true),
      };
      const lists = (view.getUint32(at + 20, true) & 1) !== 0;
      this.readFrame(frame, lists, new NumberReader(await inflate(bytes.subarray(at + 40, end))));
      this.frames.push(frame);
      at = end;
      if (performance.now() > yieldedAt + 50) {
        progress(at / bytes.length);
        await new Promise((resume) => setTimeout(resume));
        yieldedAt = performance.now();
      }
    }
    this.last = this.steps = null;
    return this;
  }

  readFrame(frame, lists, numbers) {
    const previous = this.frames.length ? this.frames[this.frames.length - 1] : null;
    if (lists || !previous) this.readParticles(frame, numbers);
    else for (const key of ["ids", "events", "materials", "radii"]) frame[key] = previous[key];
    const before = frame.ids === previous?.ids ? null
      : indicesIn(frame.ids, previous ? previous.ids : []);
    this.readPositions(frame, before, numbers);
    frame.codes = this.header.quantities.map((_, q) => {
      const codes = new Int16Array(frame.count), earlier = previous?.codes[q];
      for (let i = 0, neighbour = 0; i < frame.count; i++) {
        const k = before ? before[i] : i;
        codes[i] = neighbour = numbers.signed() + (k < 0 ? neighbour : earlier[k]);
      }
      return codes;
    });
  }

  readParticles(frame, numbers) {
    frame.ids = new Uint32Array(frame.count);
    for (let i = 0, id = 0; i < frame.count; i++) frame.ids[i] = id += numbers.unsigned();
    frame.events = numbers.list(frame.count, Uint16Array);
    frame.materials = numbers.list(frame.count, Uint8Array);
    frame.radii = this.header.radius ? numbers.list(frame.count, Int32Array) : null;
  }

  /** A position is predicted from the two before it. */
  readPositions(frame, before, numbers) {
    const { count } = frame, axes = this.header.axes, quantum = this.header.quantum_m;
    frame.positions = new Uint16Array(3 * count);
    const last = [], steps = [];
    for (let axis = 0; axis < axes.length; axis++) {
      const out = "xyz".indexOf(axes[axis]);
      const factor = (65535 * quantum) / this.size[out];
      const low = this.low[out] / quantum;
      const now = new Int32Array(count), step = new Int32Array(count);
      for (let i = 0, neighbour = 0; i < count; i++) {
        const k = before ? before[i] : i;
        const base = k < 0 ? neighbour : this.last[axis][k] + this.steps[axis][k];
        now[i] = neighbour = (base + numbers.signed()) | 0;
        if (k >= 0) step[i] = now[i] - this.last[axis][k];
        frame.positions[3 * i + out] = Math.min(65535, Math.max(0, Math.round((now[i] - low) * factor)));
      }
      last.push(now);
      steps.push(step);
    }
    this.last = last;
    this.steps = steps;
  }
}
