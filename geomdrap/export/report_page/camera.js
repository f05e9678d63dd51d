// An orthographic camera: unit vectors to the right, up and towards the viewer, the point in the middle, pixels per mm.

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const along = (a, t, d) => [a[0] + t * d[0], a[1] + t * d[1], a[2] + t * d[2]];
const scaled = (a, t) => [a[0] * t, a[1] * t, a[2] * t];
const unit = (a) => scaled(a, 1 / (Math.hypot(...a) || 1));

class Camera {
  constructor(points, low, high) {
    Object.assign(this, { points, low, high, right: [1, 0, 0], up: [0, 1, 0], toward: [0, 0, 1] });
    Object.assign(this, { width: 1, height: 1, scale: 1, middle: scaled(along(low, 1, high), 0.5) });
    this.depth = Math.hypot(...along(high, -1, low)) || 1;
  }

  // Look from a direction, with `upright` (or y) as nearly upwards as can be.
  lookFrom(toward, upright = [0, 0, 1]) {
    this.toward = unit(toward);
    const first = Math.abs(dot(unit(upright), this.toward)) < 0.99 ? upright : [0, 1, 0];
    const second = Math.abs(dot(unit(first), this.toward)) < 0.99 ? first : [1, 0, 0];
    this.right = unit(cross(second, this.toward));
    this.up = cross(this.toward, this.right);
  }

  // Bring everything into sight, with a margin in pixels.
  fit(margin) {
    let [left, below, right, above] = [Infinity, Infinity, -Infinity, -Infinity];
    for (let i = 0; i < this.points.length; i += 3) {
      const p = this.points.subarray(i, i + 3);
      const [x, y] = [dot(this.right, p), dot(this.up, p)];
      if (x < left) left = x;
      if (x > right) right = x;
      if (y < below) below = y;
      if (y > above) above = y;
    }
    if (!(right >= left)) [left, below, right, above] = [-50, -50, 50, 50];
    const room = [Math.max(this.width - 2 * margin, 20), Math.max(this.height - 2 * margin, 20)];
    this.scale = Math.min(room[0] / (right - left || 1), room[1] / (above - below || 1));
    this.base = this.scale;
    const depth = dot(this.toward, scaled(along(this.low, 1, this.high), 0.5));
    const flat = along(scaled(this.right, (left + right) / 2), (below + above) / 2, this.up);
    this.middle = along(flat, depth, this.toward);
  }

  project(p) {
    const d = along(p, -1, this.middle);
    const [x, y] = [dot(this.right, d), dot(this.up, d)];
    return [this.width / 2 + this.scale * x, this.height / 2 - this.scale * y, dot(this.toward, p)];
  }

  // All points at once, as x, y, depth in pixels, pixels, mm.
  projectAll() {
    const { points, right, up, toward, scale, middle } = this;
    const out = new Float32Array(points.length);
    const x0 = this.width / 2 - scale * dot(right, middle);
    const y0 = this.height / 2 + scale * dot(up, middle);
    for (let i = 0; i < points.length; i += 3) {
      const [x, y, z] = [points[i], points[i + 1], points[i + 2]];
      out[i] = x0 + scale * (right[0] * x + right[1] * y + right[2] * z);
      out[i + 1] = y0 - scale * (up[0] * x + up[1] * y + up[2] * z);
      out[i + 2] = toward[0] * x + toward[1] * y + toward[2] * z;
    }
    return out;
  }

  // The matrix from mm to clip space, column by column.
  matrix() {
    const { right, up, toward, middle } = this;
    const [a, b, c] = [(2 * this.scale) / this.width, (2 * this.scale) / this.height, 0.9 / this.depth];
    const far = dot(toward, scaled(along(this.low, 1, this.high), 0.5));
    const rows = [scaled(right, a), scaled(up, b), scaled(toward, -c)];
    const last = [-a * dot(right, middle), -b * dot(up, middle), c * far, 1];
    return new Float32Array([0, 1, 2].flatMap((k) => [rows[0][k], rows[1][k], rows[2][k], 0]).concat(last));
  }

  pan(dx, dy) {
    this.middle = along(along(this.middle, -dx / this.scale, this.right), dy / this.scale, this.up);
  }

  // Zoom so that what lies under the pixel (x, y) stays there.
  zoom(factor, x = this.width / 2, y = this.height / 2) {
    const scale = Math.min(Math.max(this.scale * factor, this.base / 8), this.base * 400);
    const change = scale / this.scale;
    this.pan((1 - change) * (x - this.width / 2) / change, (1 - change) * (y - this.height / 2) / change);
    this.scale = scale;
  }

  // Turn the part about the picture's own upright and level axes, degrees.
  turn(aboutUp, aboutRight) {
    const pivot = scaled(along(this.low, 1, this.high), 0.5);
    const held = this.project(pivot);
    const [s, c] = [Math.sin((aboutUp * Math.PI) / 180), Math.cos((aboutUp * Math.PI) / 180)];
    const right = along(scaled(this.right, c), s, this.toward);
    const forward = along(scaled(this.toward, c), -s, this.right);
    const [t, d] = [Math.sin((aboutRight * Math.PI) / 180), Math.cos((aboutRight * Math.PI) / 180)];
    this.toward = unit(along(scaled(forward, d), t, this.up));
    this.right = unit(along(right, -dot(right, this.toward), this.toward));
    this.up = cross(this.toward, this.right);
    const now = this.project(pivot);
    this.pan(held[0] - now[0], held[1] - now[1]);
  }
}
