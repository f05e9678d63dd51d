// One of the two views: the part, which can be turned, or the flat pattern.

const LINE_SPACING = 11;
const MARGIN = 34;
const FACTORS = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000];

class View {
  constructor(panel, model, flatView) {
    Object.assign(this, { panel, model, flatView });
    const [low, high] = flatView ? bounds(model.fabric) : bounds(model.space);
    this.points = new Float32Array(3 * model.count);
    for (let n = 0; n < model.count; n += 1) {
      const bare = flatView && model.shear[n] < BARE_BELOW; // bare vertices have no place in the fabric
      this.points.set(bare ? [NaN, NaN, NaN] : flatView ? fabricPoint(model, n) : spacePoint(model, n), 3 * n);
    }
    this.camera = new Camera(this.points, low, high);
    this.painter = new Painter(panel.querySelector("canvas"), model, flatView);
    this.overlay = new Overlay(panel.querySelector("svg"), this.camera, model, flatView);
    this.fitted = true;
  }

  resize() {
    const { width, height } = this.panel.getBoundingClientRect();
    if (!width || !height) return;
    Object.assign(this.camera, { width, height });
    this.painter.resize(width, height, window.devicePixelRatio || 1);
    if (this.fitted) this.camera.fit(MARGIN);
    this.moved();
  }

  moved() {
    this.screen = null;
  }

  fit() {
    this.fitted = true;
    this.camera.fit(MARGIN);
    this.moved();
  }

  spacing() {
    const factor = FACTORS.find((f) => f * this.model.pitch * this.camera.scale >= LINE_SPACING);
    return (factor || FACTORS[FACTORS.length - 1]) * this.model.pitch;
  }

  draw(look) {
    this.painter.draw(this.camera, { ...look, spacing: this.spacing() });
    this.overlay.update(this.spacing(), (point) => this.sees(point));
  }

  onScreen() {
    if (!this.screen) this.screen = this.camera.projectAll();
    return this.screen;
  }

  pick(x, y) {
    return pick(this.onScreen(), this.model.triangles, x, y);
  }

  // Whether nothing of the part lies before a point of it.
  sees(point) {
    if (this.flatView) return true;
    const [x, y, depth] = this.camera.project(point);
    const hit = this.pick(x, y);
    return !hit || hit.depth < depth + 0.01 * this.camera.depth;
  }

  // Where a place that was read lies in this view, or null.
  pointOf(place) {
    if (!place) return null;
    if (!this.flatView) return place.point;
    return place.u === undefined ? null : [place.u, place.v, 0];
  }

  mark(place) {
    const point = this.pointOf(place);
    this.overlay.place(point, Boolean(point) && !this.sees(point));
  }
}

function bounds({ lower, size }) {
  const low = [0, 1, 2].map((k) => lower[k] || 0);
  return [low, low.map((x, k) => x + (size[k] || 0))];
}
