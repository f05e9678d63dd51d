// One pair of shaders draws the ply on the part and flat: colours, limit line, and yarns as lines of equal u and v.

const VERTEX = `#version 300 es
uniform mat4 matrix;
uniform vec3 spaceLower, spaceSize, right, up, toward;
uniform vec2 fabricLower, fabricSize;
uniform bool flatView;
in vec3 position;
in vec2 at, normal;
in float shear;
out vec2 fabric;
out float angle, light;
void main() {
  fabric = fabricLower + fabricSize * at;
  angle = shear / 100.0;
  vec3 n = vec3(normal, 1.0 - abs(normal.x) - abs(normal.y));
  if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
  n = normalize(n);
  vec3 lamp = normalize(0.80 * toward - 0.35 * right + 0.49 * up);
  float facing = dot(n, toward) < 0.0 ? -1.0 : 1.0;
  float lit = 0.66 + 0.34 * pow(clamp(0.5 + 0.5 * facing * dot(n, lamp), 0.0, 1.0), 1.4);
  light = flatView ? 1.0 : (facing < 0.0 ? 0.84 * lit : lit);
  gl_Position = matrix * vec4(flatView ? vec3(fabric, 0.0) : spaceLower + spaceSize * position, 1.0);
}`;

const FRAGMENT = `#version 300 es
precision highp float;
uniform sampler2D table, signedTable;
uniform vec2 reach, spacing;
uniform vec3 bareColour, bareStripe, low, middle, high, limitColour, warpColour, weftColour, seamColour;
uniform float top, limit, dots;
uniform int mode;
uniform bool showWarp, showWeft, showLimit, flatView;
uniform float seams[100]; // as many strips as a roll may give, less one, and one
uniform int seamCount;
in vec2 fabric;
in float angle, light;
out vec4 colour;
float line(float coordinate, float every, float width) {
  float t = coordinate / every;
  float step = fwidth(t);
  float away = abs(t - floor(t + 0.5)) / max(step, 1e-9);
  return (1.0 - smoothstep(0.5 * width - 0.5, 0.5 * width + 0.5, away)) * (1.0 - smoothstep(0.25, 0.5, step));
}
void main() {
  float size = abs(angle);
  float slope = fwidth(size), along = max(fwidth(fabric.y), 1e-9);
  float warp = line(fabric.y, spacing.y, dots), weft = line(fabric.x, spacing.x, dots);
  if (angle < -300.0 || abs(fabric.x) > reach.x || abs(fabric.y) > reach.y) {
    if (flatView) discard;
    float stripe = mod(gl_FragCoord.x + gl_FragCoord.y, 12.0 * dots) < 3.0 * dots ? 1.0 : 0.0;
    colour = vec4(light * mix(bareColour, bareStripe, stripe), 1.0);
    return;
  }
  vec3 c = mode == 2 ? (size > limit ? high : size > 0.5 * limit ? middle : low)
    : mode == 1 ? texture(signedTable, vec2(clamp(0.5 + 0.5 * angle / top, 0.002, 0.998), 0.5)).rgb
    : texture(table, vec2(clamp(size / top, 0.002, 0.998), 0.5)).rgb;
  c *= light;
  if (showWeft) c = mix(c, weftColour, 0.55 * weft);
  if (showWarp) c = mix(c, warpColour, 0.75 * warp);
  if (showLimit && mode != 2) {
    float away = abs(size - limit) / max(slope, 1e-6);
    c = mix(c, limitColour, 1.0 - smoothstep(dots - 0.5, dots + 0.5, away));
  }
  for (int k = 0; k < seamCount; k += 1) {
    float away = abs(fabric.y - seams[k]) / along;
    c = mix(c, seamColour, 1.0 - smoothstep(1.5 * dots - 0.5, 1.5 * dots + 0.5, away));
  }
  colour = vec4(c, 1.0);
}`;

const EDGE_VERTEX = `#version 300 es
uniform mat4 matrix;
uniform vec3 spaceLower, spaceSize;
in vec3 position;
void main() {
  gl_Position = matrix * vec4(spaceLower + spaceSize * position, 1.0);
  gl_Position.z -= 0.002;
}`;

const EDGE_FRAGMENT = `#version 300 es
precision highp float;
uniform vec3 ink;
out vec4 colour;
void main() { colour = vec4(ink, 1.0); }`;

function compile(gl, vertex, fragment) {
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  return program;
}

// Sets uniforms by name; the kind follows from the value.
function setUniforms(gl, program, values) {
  gl.useProgram(program);
  for (const [name, value] of Object.entries(values)) {
    const place = gl.getUniformLocation(program, name);
    if (typeof value === "boolean") gl.uniform1i(place, value ? 1 : 0);
    else if (typeof value === "number") gl.uniform1f(place, value);
    else if (value.whole !== undefined) gl.uniform1i(place, value.whole);
    else if (value.list !== undefined) gl.uniform1fv(place, value.list);
    else if (value.length === 16) gl.uniformMatrix4fv(place, false, value);
    else gl[`uniform${value.length}fv`](place, value);
  }
}
