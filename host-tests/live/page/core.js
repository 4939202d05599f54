// The module: the core as it was compiled, its memory, and one call for each thing that it does.

// The smallest module that has an instruction of SIMD128.
const SIMD = new Uint8Array([
  0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253,
  98, 11,
]);

class Core {
  // The module from its bytes in base64. Throws a line that says what is missing.
  static async load(base64) {
    if (typeof WebAssembly !== "object" || !WebAssembly.validate(SIMD)) {
      throw new Error("This browser has no WebAssembly with SIMD, which matching takes: use a newer one.");
    }
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const page = { now: () => performance.now() };
    const { instance } = await WebAssembly.instantiate(bytes, { page });
    return new Core(instance.exports);
  }

  constructor(exports) {
    this.exports = exports;
    this.planes = null;
  }

  text(place, length) {
    return new TextDecoder().decode(new Uint8Array(this.exports.memory.buffer, place, length));
  }

  get kernel() {
    return this.text(this.exports.kernel(), this.exports.kernel_bytes());
  }

  get message() {
    return this.text(this.exports.message(), this.exports.message_bytes());
  }

  get settings() {
    return new Int32Array(this.exports.memory.buffer, this.exports.settings(), CONTROLS.length);
  }

  // Makes room for pictures of a size, and lends views of it. Throws a line where there is none.
  begin(width, height) {
    const first = this.exports.begin(width, height);
    if (first === 0) throw new Error(`${width} x ${height}: there is no memory for pictures of this size.`);
    const pixels = width * height;
    const plane = 4 * Math.ceil(pixels / 4);
    const view = (Type, place) => new Type(this.exports.memory.buffer, first + place * plane, pixels);
    this.planes = {
      width,
      height,
      left: view(Uint8Array, 0),
      right: view(Uint8Array, 1),
      flags: view(Uint8Array, 2),
      confidence: view(Uint8Array, 3),
      disparity: view(Uint16Array, 4),
      depth: view(Uint16Array, 6),
      sigma: view(Float32Array, 8),
    };
    return this.planes;
  }

  // Matches; the milliseconds. Throws the core's line.
  run() {
    const time = this.exports.run();
    if (time < 0) throw new Error(this.message);
    return time;
  }

  // Tells depth. Throws the core's line.
  depth(focalPx, baselineM, offsetPx) {
    if (this.exports.depth(focalPx, baselineM, offsetPx) === 0) throw new Error(this.message);
  }
}
