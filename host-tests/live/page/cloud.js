// The points of a result, turned and drawn on the plain canvas: no graphics processor is needed.

const MOST_POINTS = 400000;

class Cloud {
  constructor() {
    this.forget();
    this.reset();
  }

  reset() {
    [this.yaw, this.pitch, this.zoom] = [0.25, 0.2, 1];
  }

  // The points are no longer those of the result.
  forget() {
    [this.points, this.isTaken] = [null, false];
  }

  // Takes the points of a result, once: where each pixel with a depth lies, m, and its colour. The nearest
  // and the farthest ones do not move the centre.
  take({ planes, pair, rig, hasDepth, ratio }) {
    if (this.isTaken) return;
    this.isTaken = true;
    if (!hasDepth) return;
    const { width, height, depth } = planes;
    const step = Math.max(1, Math.ceil(Math.sqrt((width * height) / MOST_POINTS)));
    const colours = new Uint32Array(pair.left.pixels.buffer, pair.left.pixels.byteOffset, width * height);
    const found = [];
    for (let y = 0; y < height; y += step) {
      for (let x = 0; x < width; x += step) {
        if (depth[y * width + x] > 0) found.push(y * width + x);
      }
    }
    if (found.length === 0) return;
    const sorted = Uint16Array.from(found, (pixel) => depth[pixel]).sort();
    const [near, far] = [0.02, 0.98].map((share) => sorted[Math.floor(share * (sorted.length - 1))] / 1000);
    const places = new Float32Array(3 * found.length);
    const focal = rig.focal_px / ratio;
    const [cx, cy] = [(width - 1) / 2, (height - 1) / 2];
    found.forEach((pixel, i) => {
      const z = depth[pixel] / 1000;
      const [x, y] = [pixel % width, Math.floor(pixel / width)];
      places[3 * i] = ((x - cx) * z) / focal;
      places[3 * i + 1] = ((y - cy) * z) / focal;
      places[3 * i + 2] = z;
    });
    this.points = { places, colours: Uint32Array.from(found, (pixel) => colours[pixel]) };
    // It is turned about the middle of what is seen, and looked at from where the camera stood.
    this.centre = (near + far) / 2;
    this.focal = focal;
    this.size = Math.max(2, step + 1);
  }

  // Draws all points, the nearer ones before the others; how many.
  draw(words, width, height) {
    words.fill(BLACK);
    if (!this.points) return 0;
    const depths = new Float32Array(words.length).fill(Infinity);
    const { places, colours } = this.points;
    const { centre, focal, size } = this;
    const [sinYaw, cosYaw] = [Math.sin(this.yaw), Math.cos(this.yaw)];
    const [sinPitch, cosPitch] = [Math.sin(this.pitch), Math.cos(this.pitch)];
    const away = centre / this.zoom;
    for (let i = 0, p = 0; i < colours.length; i += 1, p += 3) {
      const z0 = places[p + 2] - centre;
      const x = places[p] * cosYaw + z0 * sinYaw;
      const z1 = z0 * cosYaw - places[p] * sinYaw;
      const y = places[p + 1] * cosPitch - z1 * sinPitch;
      const z = z1 * cosPitch + places[p + 1] * sinPitch + away;
      if (z <= 0.01) continue;
      const left = Math.round((focal * x) / z + width / 2);
      const top = Math.round((focal * y) / z + height / 2);
      for (let v = Math.max(top, 0); v < Math.min(top + size, height); v += 1) {
        for (let u = Math.max(left, 0); u < Math.min(left + size, width); u += 1) {
          const at = v * width + u;
          if (z < depths[at]) {
            depths[at] = z;
            words[at] = colours[i];
          }
        }
      }
    }
    return colours.length;
  }

  turn(yaw, pitch) {
    this.yaw += yaw;
    this.pitch = Math.min(Math.max(this.pitch + pitch, -1.5), 1.5);
  }

  comeNearer(factor) {
    this.zoom = Math.min(Math.max(this.zoom * factor, 0.1), 20);
  }
}
