// The ply as typed arrays: the page's two script blocks of data, unpacked. Lengths are in mm, angles in degrees.

const BARE = -32768;
const BARE_BELOW = -30000;
const STEPS = 65535;

function readModel() {
  const about = JSON.parse(document.getElementById("about").textContent);
  const text = atob(document.getElementById("mesh").textContent.trim());
  const bytes = Uint8Array.from(text, (c) => c.charCodeAt(0));
  const kinds = { uint8: Uint8Array, int16: Int16Array, uint16: Uint16Array, uint32: Uint32Array };
  const arrays = {};
  for (const [name, kind, offset, length] of about.arrays) {
    arrays[name] = new kinds[kind](bytes.buffer, offset, length);
  }
  return { ...about, ...arrays, count: arrays.shear.length };
}

// Coordinates of vertex n: of the part (x, y, z) or of the flat fabric (u, v, 0).
function spacePoint(model, n) {
  const { lower, size } = model.space;
  const p = model.position;
  return [0, 1, 2].map((k) => lower[k] + (size[k] * p[3 * n + k]) / STEPS);
}

function fabricPoint(model, n) {
  const { lower, size } = model.fabric;
  return [lower[0] + (size[0] * model.at[2 * n]) / STEPS, lower[1] + (size[1] * model.at[2 * n + 1]) / STEPS, 0];
}

function blend(points, shares) {
  return [0, 1, 2].map((k) => points.reduce((sum, p, i) => sum + shares[i] * p[k], 0));
}

// What lies at a place of a triangle: the place in space and in the fabric, shear, thickness factor, or why it is bare.
function readPlace(model, triangle, shares) {
  const corners = [0, 1, 2].map((k) => model.triangles[3 * triangle + k]);
  const point = blend(corners.map((n) => spacePoint(model, n)), shares);
  const code = model.shear[corners[0]];
  if (code < BARE_BELOW) return { point, bare: model.reasons[code - BARE] };
  const [u, v] = blend(corners.map((n) => fabricPoint(model, n)), shares);
  if (model.reach && (Math.abs(u) > model.reach[0] || Math.abs(v) > model.reach[1])) {
    return { point, bare: model.beyond };
  }
  const shear = corners.reduce((sum, n, i) => sum + shares[i] * model.shear[n], 0) / 100;
  const share = Math.abs(shear) / model.limit;
  const band = share > 1 ? 2 : share > 0.5 ? 1 : 0;
  return { point, u, v, shear, band, thickness: 1 / Math.cos((shear * Math.PI) / 180) };
}
