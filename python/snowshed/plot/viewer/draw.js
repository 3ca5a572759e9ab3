// Draws particles as lit balls and solids as lit triangles, with WebGL 2.

const PARTICLE_VERTEX = `#version 300 es
precision highp float;
layout(location = 0) in vec3 fromPlace;
layout(location = 1) in vec3 toPlace;
layout(location = 2) in float fromCode;
layout(location = 3) in float toCode;
layout(location = 4) in float ballRadius;
uniform mat4 matrix;
uniform vec3 low, size;
uniform float part, radius, pixels, eye;
uniform vec2 codeRange;    // of the colours, in codes or numbers
uniform float codeStep;    // of the quantity; 0: codes are numbers already
uniform vec4 section;      // what lies beyond the plane is left out
uniform vec2 pointLimit;
out float shade;
out float beyond;
void main() {
  vec3 place = low + size * mix(fromPlace, toPlace, part);
  float code = mix(fromCode, toCode, part);
  float value = codeStep > 0.0 ? 64.0 * codeStep * sinh(code / 64.0) : code;
  shade = clamp((value - codeRange.x) / max(codeRange.y - codeRange.x, 1e-20), 0.0, 1.0);
  beyond = dot(section.xyz, place) - section.w;
  gl_Position = matrix * vec4(place, 1.0);
  float own = ballRadius > 0.0 ? ballRadius : radius;
  float scale = eye > 0.0 ? eye / gl_Position.w : 1.0;
  gl_PointSize = clamp(2.0 * own * pixels * scale, pointLimit.x, pointLimit.y);
}`;

const PARTICLE_FRAGMENT = `#version 300 es
precision highp float;
in float shade;
in float beyond;
uniform sampler2D colours;
uniform float flatness;
out vec4 colour;
void main() {
  if (beyond > 0.0) discard;
  vec2 at = vec2(2.0, -2.0) * (gl_PointCoord - 0.5);
  float square = dot(at, at);
  if (square > 1.0) discard;
  vec3 normal = vec3(at, sqrt(1.0 - square));
  float light = 0.62 + 0.42 * max(dot(normal, normalize(vec3(-0.35, 0.75, 0.6))), 0.0);
  vec3 base = texture(colours, vec2(0.5 / 256.0 + shade * 255.0 / 256.0, 0.5)).rgb;
  colour = vec4(base * mix(light, 1.0, flatness), 1.0);
}`;

const SOLID_VERTEX = `#version 300 es
precision highp float;
layout(location = 0) in vec3 corner;
uniform mat4 matrix, motion;
out vec3 place;
void main() {
  vec4 moved = motion * vec4(corner, 1.0);
  place = moved.xyz;
  gl_Position = matrix * moved;
}`;

const SOLID_FRAGMENT = `#version 300 es
precision highp float;
in vec3 place;
uniform vec4 paint, section;
uniform vec3 gridPaint;
uniform float gridSize, flatness;
out vec4 colour;
void main() {
  if (dot(section.xyz, place) > section.w) discard;
  vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
  float light = mix(0.72 + 0.28 * abs(dot(normal, normalize(vec3(-0.45, -0.5, 0.74)))), 1.0, flatness);
  vec3 base = paint.rgb;
  if (gridSize > 0.0) {
    vec2 at = place.xy / gridSize, wide = fwidth(at);
    vec2 away = abs(fract(at - 0.5) - 0.5) / max(wide, vec2(1e-6));
    float line = 1.0 - min(min(away.x, away.y), 1.0);
    base = mix(base, gridPaint, 0.55 * line * clamp(0.35 / max(wide.x, wide.y), 0.0, 1.0));
  }
  colour = vec4(base * light, paint.a);
}`;

const IDENTITY = new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);

class Painter {
  constructor(canvas, flat) {
    const options = { antialias: true, alpha: false, preserveDrawingBuffer: true };
    this.gl = canvas.getContext("webgl2", options);
    if (!this.gl) throw new Error("no WebGL 2");
    this.canvas = canvas;
    this.flat = flat;
    const gl = this.gl;
    this.particles = this.program(PARTICLE_VERTEX, PARTICLE_FRAGMENT);
    this.solids = this.program(SOLID_VERTEX, SOLID_FRAGMENT);
    this.colours = gl.createTexture();
    this.buffers = [0, 1, 2, 3, 4].map(() => gl.createBuffer());
    this.array = gl.createVertexArray();
    this.meshes = [];
    this.pointLimit = gl.getParameter(gl.ALIASED_POINT_SIZE_RANGE);
    this.shown = {};
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  }

  program(vertex, fragment) {
    const gl = this.gl, program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    const at = {};
    for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); i++) {
      const { name } = gl.getActiveUniform(program, i);
      at[name] = gl.getUniformLocation(program, name);
    }
    return { program, at };
  }

  /** Adds a solid: its corners (Float32, three each) and triangles, and its kind. */
  addMesh(corners, triangles, facts) {
    const gl = this.gl, array = gl.createVertexArray();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, corners, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, triangles, gl.STATIC_DRAW);
    gl.bindVertexArray(null);
    this.meshes.push({ array, count: triangles.length, ...facts });
  }

  /** Sets the colours of the scale: 256 of three bytes. */
  setColours(bytes) {
    const gl = this.gl;
    gl.bindTexture(gl.TEXTURE_2D, this.colours);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB8, 256, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, bytes);
    for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, side, gl.CLAMP_TO_EDGE);
    for (const use of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, use, gl.NEAREST);
  }

  /** Hands over the particles of two frames, aligned, and the numbers that colour them. */
  setParticles(from, to, fromCodes, toCodes, radii) {
    const gl = this.gl;
    gl.bindVertexArray(this.array);
    const put = (slot, data, width, type, normalised) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[slot]);
      gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
      gl.enableVertexAttribArray(slot);
      gl.vertexAttribPointer(slot, width, type, normalised, 0, 0);
    };
    put(0, from, 3, gl.UNSIGNED_SHORT, true);
    put(1, to, 3, gl.UNSIGNED_SHORT, true);
    put(2, fromCodes, 1, gl.SHORT, false);
    put(3, toCodes, 1, gl.SHORT, false);
    if (radii) put(4, radii, 1, gl.FLOAT, false);
    else {
      gl.disableVertexAttribArray(4);
      gl.vertexAttrib1f(4, 0);
    }
    gl.bindVertexArray(null);
    this.count = fromCodes.length;
  }

  /** Fits the picture to its place on the page; returns its width over its height. */
  resize() {
    const { canvas } = this, ratio = Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.max(1, Math.round(canvas.clientWidth * ratio));
    const height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    return width / height;
  }

  draw(view, look) {
    const gl = this.gl;
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(...look.back, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (this.flat) gl.disable(gl.DEPTH_TEST);
    else gl.enable(gl.DEPTH_TEST);
    this.drawSolids(view, look);
    this.drawParticles(view, look);
  }

  drawSolids(view, look) {
    const gl = this.gl, { program, at } = this.solids;
    gl.useProgram(program);
    gl.uniformMatrix4fv(at.matrix, false, view.matrix);
    gl.uniform1f(at.flatness, this.flat ? 1 : 0);
    gl.uniform3fv(at.gridPaint, look.grid);
    gl.polygonOffset(-1, -1); // pressed faces lie on the faces of solids
    for (const mesh of this.meshes) {
      if (mesh.event && mesh.event !== look.pressed) continue;
      (mesh.event ? gl.enable : gl.disable).call(gl, gl.POLYGON_OFFSET_FILL);
      gl.uniformMatrix4fv(at.motion, false, mesh.motion ? mesh.motion(look.time) : IDENTITY);
      gl.uniform4fv(at.section, mesh.cut ? look.section : [0, 0, 0, 1]);
      gl.uniform4f(at.paint, ...(mesh.paint ?? look.paints[mesh.kind]), 1);
      gl.uniform1f(at.gridSize, mesh.grid || 0);
      gl.bindVertexArray(mesh.array);
      gl.drawElements(gl.TRIANGLES, mesh.count, gl.UNSIGNED_INT, 0);
    }
    gl.bindVertexArray(null);
  }

  drawParticles(view, look) {
    if (!this.count) return;
    const gl = this.gl, { program, at } = this.particles;
    gl.useProgram(program);
    gl.uniformMatrix4fv(at.matrix, false, view.matrix);
    gl.uniform3fv(at.low, look.low);
    gl.uniform3fv(at.size, look.size);
    gl.uniform1f(at.part, look.part);
    gl.uniform1f(at.radius, look.radius);
    gl.uniform1f(at.pixels, view.pixels);
    gl.uniform1f(at.eye, view.eye);
    gl.uniform2fv(at.codeRange, look.range);
    gl.uniform1f(at.codeStep, look.step);
    gl.uniform4fv(at.section, look.section);
    gl.uniform1f(at.flatness, this.flat ? 0.7 : 0);
    gl.uniform2f(at.pointLimit, Math.min(1.5, this.pointLimit[1]), this.pointLimit[1]);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.colours);
    gl.uniform1i(at.colours, 0);
    gl.bindVertexArray(this.array);
    gl.drawArrays(gl.POINTS, 0, this.count);
    gl.bindVertexArray(null);
  }
}
