// Draws a model with a camera on a canvas.

class NoWebGL extends Error {}

class Painter {
  constructor(canvas, model, flatView) {
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: true, preserveDrawingBuffer: true });
    if (!gl) throw new NoWebGL();
    Object.assign(this, { canvas, gl, model, flatView });
    this.ply = compile(gl, VERTEX, FRAGMENT);
    this.edge = compile(gl, EDGE_VERTEX, EDGE_FRAGMENT);
    this.plyArrays = this.arrays(this.ply, [
      ["position", model.position, 3, gl.UNSIGNED_SHORT, true],
      ["at", model.at, 2, gl.UNSIGNED_SHORT, true],
      ["normal", model.normal, 2, gl.SHORT, true],
      ["shear", model.shear, 1, gl.SHORT, false],
    ]);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, model.triangles, gl.STATIC_DRAW);
    this.index = model.triangles instanceof Uint32Array ? gl.UNSIGNED_INT : gl.UNSIGNED_SHORT;
    this.edgeArrays = this.arrays(this.edge, [["position", model.edges, 3, gl.UNSIGNED_SHORT, true]]);
    this.textures = [model.table, model.signedTable].map((table) => this.texture(table));
  }

  arrays(program, list) {
    const { gl } = this;
    const made = gl.createVertexArray();
    gl.bindVertexArray(made);
    for (const [name, values, size, kind, normalized] of list) {
      const place = gl.getAttribLocation(program, name);
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, padded(values, size), gl.STATIC_DRAW);
      if (place < 0) continue;
      gl.enableVertexAttribArray(place);
      const stride = 4 * Math.ceil((size * values.BYTES_PER_ELEMENT) / 4);
      gl.vertexAttribPointer(place, size, kind, normalized, stride, 0);
    }
    return made;
  }

  texture(table) {
    const { gl } = this;
    const made = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, made);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB8, table.length / 3, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, table);
    for (const name of ["TEXTURE_MIN_FILTER", "TEXTURE_MAG_FILTER"]) {
      gl.texParameteri(gl.TEXTURE_2D, gl[name], gl.LINEAR);
    }
    for (const name of ["TEXTURE_WRAP_S", "TEXTURE_WRAP_T"]) {
      gl.texParameteri(gl.TEXTURE_2D, gl[name], gl.CLAMP_TO_EDGE);
    }
    return made;
  }

  resize(width, height, ratio) {
    this.canvas.width = Math.max(1, Math.round(width * ratio));
    this.canvas.height = Math.max(1, Math.round(height * ratio));
    this.ratio = ratio;
  }

  draw(camera, look) {
    const { gl, model } = this;
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    this.textures.forEach((texture, n) => {
      gl.activeTexture(gl.TEXTURE0 + n);
      gl.bindTexture(gl.TEXTURE_2D, texture);
    });
    const place = { matrix: camera.matrix(), spaceLower: model.space.lower, spaceSize: model.space.size };
    setUniforms(gl, this.ply, {
      ...place, ...look.colours, flatView: this.flatView, right: camera.right, up: camera.up, toward: camera.toward,
      fabricLower: model.fabric.lower, fabricSize: model.fabric.size, reach: model.reach || [1e30, 1e30],
      spacing: [look.spacing, look.spacing], top: model.top, limit: model.limit, dots: this.ratio,
      mode: { whole: look.mode }, showWarp: look.warp, showWeft: look.weft, showLimit: look.limit,
      seams: { list: model.seams || [0] }, seamCount: { whole: (model.seams || []).length },
      table: { whole: 0 }, signedTable: { whole: 1 },
    });
    gl.bindVertexArray(this.plyArrays);
    gl.drawElements(gl.TRIANGLES, model.triangles.length, this.index, 0);
    if (this.flatView || !model.edges.length) return;
    setUniforms(gl, this.edge, { ...place, ink: look.ink });
    gl.bindVertexArray(this.edgeArrays);
    gl.drawArrays(gl.LINES, 0, model.edges.length / 3);
  }
}

// Rows of 16-bit values, each filled up to a multiple of four bytes, as graphics cards want them.
function padded(values, size) {
  const wide = 2 * Math.ceil(size / 2);
  if (wide === size) return values;
  const out = new values.constructor((values.length / size) * wide);
  for (let i = 0, j = 0; i < values.length; i += size, j += wide) {
    for (let k = 0; k < size; k += 1) out[j + k] = values[i + k];
  }
  return out;
}
