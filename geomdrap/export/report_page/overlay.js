// What lies over a view in crisp lines: contours, rosette, scale bar, axes, and the mark of the place that is read.

const SVG = "http://www.w3.org/2000/svg";

function svgElement(name, parent, attributes = {}) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return parent.appendChild(made);
}

const ARROW = "M-9,-3.5 L0,0 L-9,3.5 Z";

class Overlay {
  constructor(svg, camera, model, flatView) {
    Object.assign(this, { svg, camera, model, flatView });
    if (flatView) {
      this.contour = svgElement("path", svg, { d: model.contour, class: "contour", "vector-effect": "non-scaling-stroke" });
    }
    this.rosette = svgElement("g", svg, { class: "rosette" });
    this.arms = ["warp", "weft"].map((name) => ({
      halo: svgElement("line", this.rosette, { class: "halo" }),
      line: svgElement("line", this.rosette, { class: name }),
      head: svgElement("path", this.rosette, { d: ARROW, class: "head" }),
      text: svgElement("text", this.rosette, { class: "label" }),
      name,
    }));
    this.arms.forEach((arm) => { arm.text.textContent = arm.name; });
    this.dot = svgElement("circle", this.rosette, { r: 3.5, class: "seed" });
    this.axes = flatView ? [] : ["x", "y", "z"].map((name) => {
      const line = svgElement("line", svg, { class: "axis" });
      const text = svgElement("text", svg, { class: "axis-name" });
      text.textContent = name;
      return { line, text };
    });
    this.bar = svgElement("path", svg, { class: "bar" });
    this.words = svgElement("text", svg, { class: "bar-words" });
    this.mark = svgElement("g", svg, { class: "mark", visibility: "hidden" });
    svgElement("circle", this.mark, { r: 8, class: "mark-halo" });
    svgElement("circle", this.mark, { r: 8 });
    svgElement("circle", this.mark, { r: 1.2 });
  }

  update(spacing, seen) {
    const { camera, model } = this;
    if (this.contour) {
      const [x, y] = camera.project([0, 0, 0]);
      this.contour.setAttribute("transform", `matrix(${camera.scale} 0 0 ${-camera.scale} ${x} ${y})`);
    }
    const arms = this.flatView ? [[1, 0, 0], [0, 1, 0]] : [model.warp, model.weft];
    const origin = this.flatView ? [0, 0, 0] : model.origin;
    this.drawRosette(camera.project(origin), arms);
    this.rosette.classList.toggle("hidden-behind", !seen(origin));
    this.drawAxes();
    this.drawBar(spacing);
  }

  drawRosette([x, y], arms) {
    this.dot.setAttribute("cx", x);
    this.dot.setAttribute("cy", y);
    this.arms.forEach((arm, n) => {
      const size = n ? 34 : 48;
      const [dx, dy] = [size * dot(this.camera.right, arms[n]), -size * dot(this.camera.up, arms[n])];
      for (const line of [arm.halo, arm.line]) {
        line.setAttribute("x1", x);
        line.setAttribute("y1", y);
        line.setAttribute("x2", x + 0.9 * dx);
        line.setAttribute("y2", y + 0.9 * dy);
      }
      const short = Math.hypot(dx, dy) < 12;
      const turned = (Math.atan2(dy, dx) * 180) / Math.PI;
      arm.head.setAttribute("transform", `translate(${x + dx} ${y + dy}) rotate(${turned})`);
      arm.head.setAttribute("visibility", short ? "hidden" : "inherit");
      const length = Math.hypot(dx, dy) || 1;
      const out = 1 + (9 + (10 * Math.abs(dx)) / length) / length;
      arm.text.setAttribute("x", x + out * dx);
      arm.text.setAttribute("y", y + out * dy + 4);
      arm.text.setAttribute("visibility", short ? "hidden" : "inherit");
    });
  }

  drawAxes() {
    const [x, y] = [34, this.camera.height - 34];
    this.axes.forEach(({ line, text }, k) => {
      const [dx, dy] = [this.camera.right[k], -this.camera.up[k]];
      line.setAttribute("x1", x);
      line.setAttribute("y1", y);
      line.setAttribute("x2", x + 18 * dx);
      line.setAttribute("y2", y + 18 * dy);
      text.setAttribute("x", x + 26 * dx);
      text.setAttribute("y", y + 26 * dy + 3.5);
      text.setAttribute("visibility", Math.hypot(dx, dy) < 0.15 ? "hidden" : "inherit");
    });
  }

  drawBar(spacing) {
    const { width, height, scale } = this.camera;
    const length = roundDown(Math.min(0.28 * width, 170) / scale);
    const [x, y] = [this.flatView ? 16 : 72, height - 16];
    this.bar.setAttribute("d", `M${x},${y - 6} v6 h${length * scale} v-6`);
    this.words.setAttribute("x", x + 4);
    this.words.setAttribute("y", y - 10);
    this.words.textContent = `${short(length)} mm · yarns every ${short(spacing)} mm`;
  }

  // Show or hide the mark at a point of this view; hollow where the part hides it.
  place(point, hidden) {
    this.mark.setAttribute("visibility", point ? "visible" : "hidden");
    if (!point) return;
    const [x, y] = this.camera.project(point);
    this.mark.setAttribute("transform", `translate(${x} ${y})`);
    this.mark.classList.toggle("hidden-behind", hidden);
  }
}

const short = (x) => String(Number(x.toPrecision(4)));

// The greatest of ..., 1, 2, 5, 10, ... that is not over the limit.
function roundDown(limit) {
  const decade = 10 ** Math.floor(Math.log10(limit));
  return [5, 2, 1].map((step) => step * decade).find((length) => length <= limit * (1 + 1e-9));
}
