// The triangle under a pixel: each triangle on the screen is tried, and of those that hold the pixel the nearest is taken.

function pick(screen, triangles, x, y) {
  let [best, depth, shares] = [-1, -Infinity, null];
  for (let f = 0; f < triangles.length; f += 3) {
    const [a, b, c] = [3 * triangles[f], 3 * triangles[f + 1], 3 * triangles[f + 2]];
    const [ax, ay] = [screen[a] - x, screen[a + 1] - y];
    const [bx, by] = [screen[b] - x, screen[b + 1] - y];
    const [cx, cy] = [screen[c] - x, screen[c + 1] - y];
    const [p, q, r] = [bx * cy - by * cx, cx * ay - cy * ax, ax * by - ay * bx];
    const inside = (p >= 0 && q >= 0 && r >= 0) || (p <= 0 && q <= 0 && r <= 0);
    const sum = p + q + r;
    if (!inside || sum === 0) continue;
    const z = (p * screen[a + 2] + q * screen[b + 2] + r * screen[c + 2]) / sum;
    if (z > depth) [best, depth, shares] = [f / 3, z, [p / sum, q / sum, r / sum]];
  }
  return best < 0 ? null : { triangle: best, shares, depth };
}
