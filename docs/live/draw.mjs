// Particles as round points and obstacles as polygons, by WebGL2.
import { HEIGHT, WIDTH } from './scenes.mjs';

const PARTICLES = `#version 300 es
  in vec2 place;
  in vec2 velocity;
  in float height;
  uniform vec2 scale;
  uniform float size, layers;
  uniform vec3 colour, fast;
  out vec3 shade;
  void main() {
    gl_Position = vec4(place * scale - 1.0, 0, 1);
    gl_PointSize = size;
    float band = layers > 0.0 ? mod(floor(min(height, 0.999) * layers), 2.0) : 0.0;
    shade = mix(colour * (1.0 - 0.28 * band), fast, 0.75 * smoothstep(0.3, 4.0, length(velocity)));
  }`;
const DISC = `#version 300 es
  precision mediump float;
  in vec3 shade;
  out vec4 pixel;
  void main() {
    vec2 from = gl_PointCoord - 0.5;
    float inside = 1.0 - smoothstep(0.2, 0.25, dot(from, from));
    if (inside == 0.0) discard;
    pixel = vec4(shade * inside, inside);
  }`;
const POLYGON = `#version 300 es
  in vec2 place;
  uniform vec2 scale;
  void main() { gl_Position = vec4(place * scale - 1.0, 0, 1); }`;
const PLAIN = `#version 300 es
  precision mediump float;
  uniform vec3 colour;
  out vec4 pixel;
  void main() { pixel = vec4(colour, 1); }`;

const colour = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);
const palette = (entries) => Object.fromEntries(Object.entries(entries).map(([name, hex]) => [name, colour(hex)]));
const DARK = palette({
  ground: '#10151c',
  obstacle: '#8b949e',
  green: '#3fb865',
  red: '#e5645c',
  blue: '#2f81f7',
  ochre: '#d9a253',
  white: '#dce6f2',
  fast: '#ffffff',
});
const LIGHT = palette({
  ground: '#f6f8fa',
  obstacle: '#57606a',
  green: '#2a9550',
  red: '#cf4a42',
  blue: '#1f6feb',
  ochre: '#b07b2c',
  white: '#8ea6c4',
  fast: '#9fd4ff',
});

const CORNERS = 48; // of a disc
/** The corners of an obstacle, as a fan. */
function outline({ shape, size }, { position: [x, y], orientation: [w, , , z] }, box) {
  const angle = 2 * Math.atan2(z, w);
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const corners =
    shape === box
      ? [
          [-1, -1],
          [1, -1],
          [1, 1],
          [-1, 1],
        ].map(([i, j]) => [i * size[0], j * size[1]])
      : Array.from({ length: CORNERS }, (_, k) => [
          size[0] * Math.cos((k * 2 * Math.PI) / CORNERS),
          size[0] * Math.sin((k * 2 * Math.PI) / CORNERS),
        ]);
  return corners.flatMap(([i, j]) => [x + c * i - s * j, y + s * i + c * j]);
}

export function painter(canvas, BOX) {
  const gl = canvas.getContext('webgl2', { antialias: false });
  if (!gl) throw new Error('this browser has no WebGL2');

  function programOf(...sources) {
    const program = gl.createProgram();
    [gl.VERTEX_SHADER, gl.FRAGMENT_SHADER].forEach((type, k) => {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, sources[k]);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    });
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    const place = (name) => gl.getUniformLocation(program, name);
    return {
      program,
      at: (name) => gl.getAttribLocation(program, name),
      set: (name, ...values) => gl[`uniform${values.length}f`](place(name), ...values),
    };
  }
  let points, shapes, moving, still, corners;
  let scene = null;
  let bands = new Float32Array(0);

  /** Makes what goes with the context. */
  function make() {
    points = programOf(PARTICLES, DISC);
    shapes = programOf(POLYGON, PLAIN);
    [moving, still, corners] = [gl.createBuffer(), gl.createBuffer(), gl.createBuffer()];
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    keepBands();
  }
  function keepBands() {
    gl.bindBuffer(gl.ARRAY_BUFFER, still);
    gl.bufferData(gl.ARRAY_BUFFER, bands, gl.STATIC_DRAW);
  }
  make();
  canvas.addEventListener('webglcontextlost', (event) => event.preventDefault()); // else it never comes back
  canvas.addEventListener('webglcontextrestored', make);

  function attribute(program, name, buffer, size, stride, offset) {
    const at = program.at(name);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, size, gl.FLOAT, false, stride, offset);
  }

  return {
    /** Takes what stays the same: colours, sizes and bands. */
    open(recipe, heights) {
      scene = { ...recipe, counts: heights.map((one) => one.length) };
      bands = new Float32Array(scene.counts.reduce((a, b) => a + b, 0));
      let at = 0;
      for (const one of heights) {
        bands.set(one, at);
        at += one.length;
      }
      keepBands();
    },
    draw({ floats, obstacles }, dark) {
      const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((one) =>
        Math.max(1, Math.round(one * devicePixelRatio)),
      );
      if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
      gl.viewport(0, 0, width, height);
      const colours = dark ? DARK : LIGHT;
      gl.clearColor(...colours.ground, 1);
      gl.clear(gl.COLOR_BUFFER_BIT);
      const scale = [2 / WIDTH, 2 / HEIGHT];

      gl.bindBuffer(gl.ARRAY_BUFFER, moving);
      gl.bufferData(gl.ARRAY_BUFFER, floats, gl.STREAM_DRAW);
      gl.useProgram(points.program);
      points.set('scale', ...scale);
      points.set('size', Math.max(2, (0.82 * scene.h * width) / WIDTH));
      points.set('fast', ...colours.fast);
      attribute(points, 'place', moving, 2, 16, 0);
      attribute(points, 'velocity', moving, 2, 16, 8);
      attribute(points, 'height', still, 1, 4, 0);
      let at = 0;
      scene.sets.forEach(({ tint, layers }, k) => {
        points.set('colour', ...colours[tint]);
        points.set('layers', layers);
        gl.drawArrays(gl.POINTS, at, scene.counts[k]);
        at += scene.counts[k];
      });

      gl.useProgram(shapes.program);
      shapes.set('scale', ...scale);
      shapes.set('colour', ...colours.obstacle);
      obstacles.forEach((pose, k) => {
        const fan = outline(scene.obstacles[k], pose, BOX);
        attribute(shapes, 'place', corners, 2, 0, 0);
        gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(fan), gl.STREAM_DRAW);
        gl.drawArrays(gl.TRIANGLE_FAN, 0, fan.length / 2);
      });
    },
  };
}
