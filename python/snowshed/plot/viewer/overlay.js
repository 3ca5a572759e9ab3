// What is drawn over and beside the picture: legend, colours of the page, and measures.

/** Returns the colours of what is drawn, as the page's style has them. */
function look() {
  const style = getComputedStyle(document.documentElement);
  const rgb = (name) => {
    const hex = style.getPropertyValue(name).trim();
    return [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16) / 255);
  };
  return {
    back: rgb("--sky"),
    grid: rgb("--grid"),
    paints: { ground: rgb("--ground"), panel: rgb("--panel"), solid: rgb("--solid") },
  };
}

/** Returns whether the page is dark: as its reader chose, or else as the system asks for. */
function isDark() {
  const { theme } = document.documentElement.dataset;
  return theme ? theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
}

/** Draws the legend: a scale with three numbers, or a swatch for each label. */
function drawLegend(colouring, bytes) {
  const legend = el("legend"), { labels } = colouring;
  const css = (k) => `rgb(${bytes[3 * k]}, ${bytes[3 * k + 1]}, ${bytes[3 * k + 2]})`;
  legend.replaceChildren();
  const title = document.createElement("p");
  title.textContent = colouring.title;
  legend.append(title);
  if (labels) {
    legend.append(swatches(labels, (k) => css(Math.round((255 * k) / Math.max(labels.length - 1, 1)))));
    return;
  }
  const bar = document.createElement("div"), numbers = document.createElement("div");
  bar.className = "bar";
  bar.style.background = `linear-gradient(to right, ${Array.from({ length: 9 }, (_, k) => css(Math.round((255 * k) / 8))).join(", ")})`;
  numbers.className = "numbers";
  for (const part of [0, 0.5, 1]) {
    const number = document.createElement("span");
    number.textContent = shortNumber(colouring.low + part * (colouring.high - colouring.low));
    numbers.append(number);
  }
  legend.append(bar, numbers);
}

/** Returns a list of labels, each with its colour. */
function swatches(labels, colourOf) {
  const list = document.createElement("ul");
  labels.forEach((label, k) => {
    const item = document.createElement("li"), swatch = document.createElement("span");
    swatch.className = "swatch";
    swatch.style.background = colourOf(k);
    item.append(swatch, label);
    list.append(item);
  });
  return list;
}

/** Adds the scale of pressures to the legend. */
function addSwatches({ title, labels, colours }) {
  const head = document.createElement("p");
  head.textContent = title;
  head.className = "next";
  const css = (k) => `rgb(${colours[k].map((part) => Math.round(255 * part)).join(", ")})`;
  el("legend").append(head, swatches(labels, css));
}

function shortNumber(value) {
  if (value === 0) return "0";
  const size = Math.abs(value);
  return size >= 1e5 || size < 1e-3 ? value.toExponential(1) : Number(value.toPrecision(3)).toLocaleString("en");
}

/** Draws the measures of an event at its end, as lines with their lengths. */
function drawMeasures(view, camera, frame, index) {
  const svg = el("measures"), { frames } = view.film;
  const ended = index === frames.length - 1 || frames[index + 1].event !== frame.event;
  const { event } = frame, shown = ended && view.measures;
  const lines = shown ? view.data.measures.filter((line) => line.event === event) : [];
  const { clientWidth: width, clientHeight: height } = el("picture");
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.replaceChildren();
  const taken = [];
  for (const line of lines) {
    const [a, b] = [line.from, line.to].map((point) => project(camera.matrix, point, width, height));
    if (!a.seen || !b.seen) continue;
    svg.append(svgPart("line", { x1: a.x, y1: a.y, x2: b.x, y2: b.y, class: "halo" }));
    svg.append(svgPart("line", { x1: a.x, y1: a.y, x2: b.x, y2: b.y, "marker-start": "url(#tick)", "marker-end": "url(#tick)" }));
    const upright = Math.abs(b.y - a.y) > Math.abs(b.x - a.x);
    const place = { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 + (upright ? 4 : 19) };
    const fall = (b.y - a.y) / (b.x - a.x);  // beside a sloping line, the label keeps off it
    const anchor = upright ? "start" : Math.abs(fall) < 0.1 ? "middle" : fall > 0 ? "end" : "start";
    place.x += anchor === "middle" ? 0 : anchor === "start" ? 9 : -9;
    while (taken.some((other) => Math.abs(other.y - place.y) < 17 && Math.abs(other.x - place.x) < 150)) place.y += 17;
    taken.push(place);
    const label = svgPart("text", { ...place, "text-anchor": anchor });
    label.textContent = line.label;
    svg.append(label);
  }
  const text = lines.map((line) => line.label).join("; ");
  const told = text ? `After event ${event}: ${text}.` : "";
  if (el("told").textContent !== told) el("told").textContent = told;
}

function svgPart(name, attributes) {
  const part = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) part.setAttribute(key, value);
  return part;
}
