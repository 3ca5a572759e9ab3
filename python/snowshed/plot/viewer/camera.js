// The camera: it turns about a point (in space) or looks at a plane from the side (flat), and
// says where points of the scene are on the picture. Matrices are columns of four.

const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0],
];
const unit = (a) => a.map((x) => x / Math.hypot(...a));

class Camera {
  /** Looks at what `focus` ({low, high}) holds, from `lift` (radians) above the horizon. */
  constructor(focus, flat, lift) {
    this.flat = flat;
    this.firstLift = lift;
    this.focus = focus;
    this.aspect = 1;
    this.reset();
  }

  reset() {
    const { low, high } = this.focus;
    this.target = low.map((x, k) => 0.5 * (x + high[k]));
    this.turn = this.flat ? 0 : -0.6; // about z; 0 looks along +y
    this.lift = this.flat ? 0 : this.firstLift; // above the horizon
    this.zoom = 1;
  }

  /** Half the height of the picture at the target, m, so that all fits in. */
  get reach() {
    const size = this.focus.high.map((x, k) => x - this.focus.low[k]);
    const wide = this.flat ? size[0] : Math.hypot(size[0], size[1]) * 0.85 + 0.15 * size[2];
    const high = this.flat ? size[2] : size[2] + 0.35 * Math.hypot(size[0], size[1]);
    return (0.54 * Math.max(high, wide / this.aspect, 1e-9)) / this.zoom;
  }

  get directions() {
    const c = Math.cos(this.turn), s = Math.sin(this.turn);
    const back = [s * Math.cos(this.lift), -c * Math.cos(this.lift), Math.sin(this.lift)];
    const right = [c, s, 0];
    return { right, up: cross(back, right), back };
  }

  orbit(dx, dy) {
    if (this.flat) return this.pan(dx, dy);
    this.turn -= dx * 3;
    this.lift = Math.max(-0.2, Math.min(1.55, this.lift + dy * 3));
  }

  /** Moves what is seen by parts of the picture's height. */
  pan(dx, dy) {
    const { right, up } = this.directions, scale = 2 * this.reach;
    this.target = this.target.map((x, k) => x - scale * (dx * right[k] - dy * up[k]));
  }

  magnify(factor) {
    this.zoom = Math.max(0.1, Math.min(200, this.zoom * factor));
  }

  /** Returns the matrix from the scene to the picture, and the pixels of a metre at the target. */
  matrix(pixelsHigh) {
    const { right, up, back } = this.directions, reach = this.reach;
    const depth = Math.hypot(...minus(this.focus.high, this.focus.low)) * 4 + 4 * reach;
    const at = this.target;
    const view = [
      right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0,
      -dot(right, at), -dot(up, at), -dot(back, at), 1,
    ];
    if (this.flat) {
      const p = [1 / (reach * this.aspect), 0, 0, 0, 0, 1 / reach, 0, 0, 0, 0, -1 / depth, 0, 0, 0, 0, 1];
      return { matrix: product(p, view), pixels: pixelsHigh / (2 * reach), eye: 0 };
    }
    const half = 0.22, eye = reach / Math.tan(half), near = Math.max(eye * 0.02, eye - depth);
    const far = eye + depth, f = 1 / Math.tan(half);
    view[14] -= eye;
    const p = [f / this.aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1,
      0, 0, (2 * far * near) / (near - far), 0];
    return { matrix: product(p, view), pixels: pixelsHigh / (2 * reach), eye };
  }
}

function product(a, b) {
  const c = new Float32Array(16);
  for (let i = 0; i < 4; i++)
    for (let j = 0; j < 4; j++)
      for (let k = 0; k < 4; k++) c[4 * j + i] += a[4 * k + i] * b[4 * j + k];
  return c;
}

/** Returns where a point is on a picture of such a size, and whether it lies before the camera. */
function project(matrix, point, width, height) {
  const at = (row) =>
    matrix[row] * point[0] + matrix[4 + row] * point[1] + matrix[8 + row] * point[2] + matrix[12 + row];
  const w = at(3);
  return { x: (0.5 + (0.5 * at(0)) / w) * width, y: (0.5 - (0.5 * at(1)) / w) * height, seen: w > 0 };
}
