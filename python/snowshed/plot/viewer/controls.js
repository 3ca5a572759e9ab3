// Mouse, touch, keyboard and buttons.

function listen(view) {
  const canvas = el("picture"), again = () => view.playing || view.render();
  el("play").addEventListener("click", () => view.play(!view.playing));
  el("scrub").addEventListener("input", () => {
    view.play(false);
    view.go(Number(el("scrub").value));
  });
  el("speed").addEventListener("change", () => (view.rate = Number(el("speed").value)));
  el("colour").addEventListener("change", () => view.choose(Number(el("colour").value)));
  el("reset").addEventListener("click", () => {
    view.camera.reset();
    again();
  });
  el("theme").addEventListener("click", () => {
    document.documentElement.dataset.theme = isDark() ? "light" : "dark";
    if (view.film) view.dress();
  });
  el("measured")?.addEventListener("change", () => {
    view.measures = el("measured").checked;
    again();
  });
  el("pressed")?.addEventListener("change", () => {
    view.pressures = el("pressed").checked;
    if (view.film) view.dress();
  });
  for (const id of ["axis", "cut"])
    el(id)?.addEventListener("input", () => {
      view.section = { axis: Number(el("axis").value), part: Number(el("cut").value) / 100 };
      el("cut").disabled = view.section.axis < 0;
      again();
    });
  new ResizeObserver(again).observe(canvas);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => view.film && view.dress());
  listenToPointers(view, canvas, again);
  canvas.addEventListener("keydown", (event) => onKey(view, event, again));
}

/** One finger or button turns, two fingers, the right button or shift move, the wheel magnifies. */
function listenToPointers(view, canvas, again) {
  const down = new Map();
  const middle = () => {
    const all = [...down.values()];
    return {
      x: all.reduce((sum, p) => sum + p.x, 0) / all.length,
      y: all.reduce((sum, p) => sum + p.y, 0) / all.length,
      apart: all.length > 1 ? Math.hypot(all[0].x - all[1].x, all[0].y - all[1].y) : 0,
    };
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    down.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!down.has(event.pointerId)) return;
    const before = middle();
    down.set(event.pointerId, { x: event.clientX, y: event.clientY });
    const now = middle(), high = canvas.clientHeight;
    const dx = (now.x - before.x) / high, dy = (now.y - before.y) / high;
    if (down.size > 1 || event.shiftKey || event.buttons === 2) view.camera.pan(dx, dy);
    else view.camera.orbit(dx, dy);
    if (before.apart > 0) view.camera.magnify(now.apart / before.apart);
    again();
  });
  for (const end of ["pointerup", "pointercancel"])
    canvas.addEventListener(end, (event) => down.delete(event.pointerId));
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    view.camera.magnify(Math.exp(-0.0015 * event.deltaY));
    again();
  }, { passive: false });
}

const KEYS = {
  " ": (view) => view.play(!view.playing),
  ",": (view) => stepBy(view, -1),
  ".": (view) => stepBy(view, 1),
  Home: (view) => stepBy(view, -Infinity),
  End: (view) => stepBy(view, Infinity),
  "+": (view) => view.camera.magnify(1.2),
  "=": (view) => view.camera.magnify(1.2),
  "-": (view) => view.camera.magnify(1 / 1.2),
  r: (view) => view.camera.reset(),
};
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

function stepBy(view, frames) {
  view.play(false);
  view.go(view.place().index + frames);
}

function onKey(view, event, again) {
  if (!view.film || event.ctrlKey || event.altKey || event.metaKey) return;
  if (event.key in ARROWS) {
    const [x, y] = ARROWS[event.key].map((way) => 0.05 * way);
    if (event.shiftKey) view.camera.pan(x, y);
    else view.camera.orbit(x, y);
  } else if (event.key in KEYS) KEYS[event.key](view);
  else return;
  event.preventDefault();
  again();
}
