// Ties the two views, the controls and the readout together.

const MODES = ["shear", "signed", "classes"];
const BANDS = ["under half the limit", "half the limit to the limit", "over the limit"];

class Viewer {
  constructor(model) {
    this.model = model;
    this.look = { mode: 0, warp: true, weft: true, limit: true };
    const views = [["part-view", false], ["flat-view", true]];
    this.views = views.map(([id, flat]) => new View(document.getElementById(id), model, flat));
    [this.part, this.flat] = this.views;
    this.part.camera.lookFrom(model.toward);
    this.readTheme();
    for (const view of this.views) {
      listen(view, this);
      new ResizeObserver(() => this.resized(view)).observe(view.panel);
      const steps = [0, 0.2, 0.4, 0.6, 0.8, 1]; // browsers may skip what is drawn out of sight
      new IntersectionObserver(() => this.redraw(), { threshold: steps }).observe(view.panel);
      this.resized(view);
    }
    this.listenToControls();
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
      this.readTheme();
      this.redraw();
    });
  }

  readTheme() {
    const style = getComputedStyle(document.documentElement);
    const colour = (name) => hex(style.getPropertyValue(`--${name}`).trim());
    this.look.ink = colour("edge");
    this.look.colours = {
      bareColour: colour("bare"), bareStripe: colour("bare-stripe"), low: colour("low"), middle: colour("middle"),
      high: colour("high"), limitColour: colour("limit"), warpColour: colour("warp"), weftColour: colour("weft"),
      seamColour: colour("seam"),
    };
  }

  resized(view) {
    view.resize();
    view.draw(this.look);
    view.mark(this.place);
  }

  redraw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      for (const view of this.views) {
        view.draw(this.look);
        view.mark(this.place);
      }
    });
  }

  // Read what lies at a pixel of a view and show it in both; null clears.
  read(view, x, y) {
    const hit = view && view.pick(x, y);
    this.show(hit ? readPlace(this.model, hit.triangle, hit.shares) : null);
  }

  show(place) {
    this.place = place;
    for (const view of this.views) view.mark(place);
    showReadout(place);
  }

  // Move the reading by whole pitches along u and v: from the last place, else from the seed.
  step(du, dv, times) {
    const from = this.place && this.place.u !== undefined ? [this.place.u, this.place.v] : [0, 0];
    const pitch = this.model.pitch;
    const started = this.place && this.place.u !== undefined;
    const target = [0, 1].map((k) => {
      const next = from[k] + (started ? times * pitch * [du, dv][k] : 0);
      return pitch * Math.round(next / pitch);
    });
    const [x, y] = this.flat.camera.project([...target, 0]);
    const hit = this.flat.pick(x, y);
    if (!hit) return;
    this.show(readPlace(this.model, hit.triangle, hit.shares));
    const { width, height } = this.flat.camera;
    if (x < 20 || y < 20 || x > width - 20 || y > height - 20) {
      this.flat.camera.pan(width / 2 - x, height / 2 - y);
      this.flat.fitted = false;
      this.flat.moved();
      this.redraw();
    }
  }

  lookFrom(name) {
    const axes = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1], seed: this.model.normal, start: this.model.toward };
    this.part.camera.lookFrom(axes[name]);
    this.part.fit();
    this.redraw();
  }

  goTo(point, toward) {
    const { camera } = this.part;
    camera.lookFrom(unit(along(toward, 0.35, camera.toward)));
    this.part.fit();
    camera.zoom(2.5);
    const [x, y] = camera.project(point);
    camera.pan(camera.width / 2 - x, camera.height / 2 - y);
    this.part.fitted = false;
    this.part.moved();
    this.read(this.part, camera.width / 2, camera.height / 2);
    this.redraw();
  }

  shortcut(key) {
    const views = { 1: "start", 2: "seed", 3: "x", 4: "y", 5: "z" };
    const boxes = { w: "warp", f: "weft", l: "limit" };
    if (views[key]) this.lookFrom(views[key]);
    else if (key === "c") this.setMode((this.look.mode + 1) % MODES.length);
    else if (boxes[key]) this.toggle(boxes[key], !this.look[boxes[key]]);
    else return false;
    return true;
  }

  setMode(mode) {
    this.look.mode = mode;
    document.querySelector(`input[name=mode][value=${MODES[mode]}]`).checked = true;
    document.getElementById("legend").dataset.mode = MODES[mode];
    this.redraw();
  }

  toggle(name, on) {
    this.look[name] = on;
    document.getElementById(`show-${name}`).checked = on;
    this.redraw();
  }

  listenToControls() {
    MODES.forEach((name, n) => {
      document.querySelector(`input[name=mode][value=${name}]`).addEventListener("change", () => this.setMode(n));
    });
    for (const name of ["warp", "weft", "limit"]) {
      const box = document.getElementById(`show-${name}`);
      box.addEventListener("change", () => this.toggle(name, box.checked));
    }
    for (const button of document.querySelectorAll("button[data-look]")) {
      button.addEventListener("click", () => this.lookFrom(button.dataset.look));
    }
    document.getElementById("fit").addEventListener("click", () => {
      this.views.forEach((view) => view.fit());
      this.redraw();
    });
    for (const button of document.querySelectorAll("button[data-bare]")) {
      const { center, normal } = this.model.bare[Number(button.dataset.bare)];
      button.addEventListener("click", () => {
        this.part.panel.scrollIntoView({ block: "nearest" });
        this.goTo(center, normal);
      });
    }
  }
}

function showReadout(place) {
  const known = place && place.u !== undefined;
  const texts = {
    u: known ? `${place.u.toFixed(1)} mm` : "–",
    v: known ? `${place.v.toFixed(1)} mm` : "–",
    shear: known ? `${place.shear.toFixed(2)}°` : "–",
    thickness: known ? `× ${place.thickness.toFixed(3)}` : "–",
    point: place ? place.point.map((x) => x.toFixed(1)).join(", ") : "–",
    state: known ? BANDS[place.band] : place ? `bare: ${place.bare}` : "point at the part or the pattern",
  };
  for (const [name, text] of Object.entries(texts)) document.getElementById(`read-${name}`).textContent = text;
  document.getElementById("read-state").dataset.band = known ? place.band : place ? "bare" : "none";
}

function hex(text) {
  return [1, 3, 5].map((k) => parseInt(text.slice(k, k + 2), 16) / 255);
}
