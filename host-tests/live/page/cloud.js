// The points of a result, drawn and turned by the library OGL.

const MOST_POINTS = 400000;
// A point is as large as a pixel of the picture is where it lies, and no smaller than one on the screen.
const POINT_VERTEX = `
attribute vec3 position;
attribute vec4 colour;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform float size;
varying vec3 tint;
void main() {
  tint = colour.rgb;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_PointSize = clamp(size * -position.z / gl_Position.w, 1.0, 12.0);
}`;
const POINT_FRAGMENT = `
precision mediump float;
varying vec3 tint;
void main() {
  gl_FragColor = vec4(tint, 1.0);
}`;

class Cloud {
  // Turns as hands on an element ask it to.
  constructor(element) {
    this.element = element;
    this.forget();
    this.reset();
  }

  // It is seen again from where the camera stood, a little from the side.
  reset() {
    this.isPlaced = false;
  }

  // The points are no longer those of the result.
  forget() {
    [this.points, this.isTaken] = [null, false];
  }

  // Whether hands turn it.
  set isOn(isOn) {
    if (this.orbit) this.orbit.enabled = isOn;
  }

  // Takes the points of a result, once: where each pixel with a depth lies, m, and its colour. The nearest
  // and the farthest ones do not move the centre.
  take(state) {
    if (this.isTaken) return;
    [this.isTaken, this.beyond] = [true, 0];
    const { planes, pair, rig, hasDepth, ratio } = state;
    if (!hasDepth) return;
    const { width, height } = planes;
    const step = Math.max(1, Math.ceil(Math.sqrt((width * height) / MOST_POINTS)));
    const colours = new Uint32Array(pair.left.pixels.buffer, pair.left.pixels.byteOffset, width * height);
    const [found, depths] = [[], []];
    for (let y = 0; y < height; y += step) {
      for (let x = 0; x < width; x += step) {
        const pixel = y * width + x;
        if (planes.disparity[pixel] === NO_ANSWER) continue;
        const metres = state.depthAt(state, pixel);
        if (1000 * metres > FARTHEST_MM) {
          this.beyond += 1;
        } else if (metres > 0) {
          found.push(pixel);
          depths.push(metres);
        }
      }
    }
    if (found.length === 0) return;
    const sorted = Float32Array.from(depths).sort();
    const ends = [0.02, 0.98].map((share) => sorted[Math.floor(share * (sorted.length - 1))]);
    const places = new Float32Array(3 * found.length);
    // Where nothing says where the axis is, it is in the middle.
    const [cx, cy] = rig.centre_px ?? [width, height].map((length, axis) => (length * ratio[axis] - 1) / 2);
    found.forEach((pixel, i) => {
      const z = depths[i];
      const column = takenFrom(pixel % width, ratio[0]);
      const row = takenFrom(Math.floor(pixel / width), ratio[1]);
      // The library looks along -Z, and its Y is up.
      places.set([((column - cx) * z) / rig.focal_px, ((cy - row) * z) / rig.focal_px, -z], 3 * i);
    });
    this.points = { places, colours: Uint32Array.from(found, (pixel) => colours[pixel]), step,
      focal: rig.focal_px / ratio[1] };
    this.centre = (ends[0] + ends[1]) / 2;
  }

  // The library's objects, made when they are needed first; nothing where the browser has no WebGL.
  begin() {
    if (this.renderer) return true;
    const canvas = document.createElement("canvas");
    if (!(canvas.getContext("webgl2") ?? canvas.getContext("webgl"))) return false;
    canvas.addEventListener("webglcontextlost", () => (this.renderer = null));
    this.orbit?.remove();
    this.renderer = new OGL.Renderer({ canvas });
    const { gl } = this.renderer;
    gl.clearColor(0, 0, 0, 1);
    this.camera = new OGL.Camera(gl);
    this.orbit = new OGL.Orbit(this.camera, { element: this.element, target: new OGL.Vec3(), ease: 1,
      inertia: 0, rotateSpeed: 0.5, panSpeed: 1 });
    const uniforms = { size: { value: 1 } };
    const program = new OGL.Program(gl, { vertex: POINT_VERTEX, fragment: POINT_FRAGMENT, uniforms });
    this.mesh = new OGL.Mesh(gl, { mode: gl.POINTS, geometry: new OGL.Geometry(gl), program,
      frustumCulled: false });
    [this.drawn, this.isPlaced] = [null, false];
    return true;
  }

  // Draws all points into a context of the element; how many, or nothing without WebGL.
  draw(context) {
    const { width, height } = context.canvas;
    context.fillStyle = "black";
    context.fillRect(0, 0, width, height);
    if (!this.points) return 0;
    if (!this.begin()) return null;
    const { places, colours, focal, step } = this.points;
    const { renderer, camera, mesh } = this;
    const { gl } = renderer;
    if (this.drawn !== this.points) {
      mesh.geometry.remove();
      const bytes = new Uint8Array(colours.buffer);
      mesh.geometry = new OGL.Geometry(gl, { position: { size: 3, data: places },
        colour: { size: 4, data: bytes, type: gl.UNSIGNED_BYTE, normalized: true } });
      mesh.program.uniforms.size.value = 1.5 * step;
      this.drawn = this.points;
    }
    if (!this.isPlaced) this.place();
    if (gl.canvas.width !== width || gl.canvas.height !== height) renderer.setSize(width, height);
    const fov = (360 / Math.PI) * Math.atan(height / 2 / focal);
    camera.perspective({ fov, aspect: width / height, near: 0.01, far: 200 });
    this.orbit.update();
    renderer.render({ scene: mesh, camera });
    context.drawImage(gl.canvas, 0, 0);
    return colours.length;
  }

  // Looks at the middle of what is seen, from where the camera stood and a little from the side.
  place() {
    this.isPlaced = true;
    this.orbit.target.set(0, 0, -this.centre);
    this.camera.position.set(0, 0, 0);
    this.move([-0.25, 0.2], 1);
  }

  // Turns by angles, rad, and comes so many times nearer.
  move([yaw, pitch], nearer) {
    if (!this.renderer) return;
    const { camera, orbit } = this;
    const from = camera.position.clone().sub(orbit.target);
    const distance = from.len();
    const across = Math.atan2(from.x, from.z) + yaw;
    const up = Math.min(Math.max(Math.asin(from.y / distance) + pitch, -1.5), 1.5);
    const away = Math.min(Math.max(distance / nearer, 0.02), 150);
    from.set(Math.sin(across) * Math.cos(up), Math.sin(up), Math.cos(across) * Math.cos(up));
    camera.position.copy(orbit.target).add(from.scale(away));
    orbit.forcePosition();
  }
}
