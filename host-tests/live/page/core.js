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
    this.first = this.exports.begin(width, height);
    this.planes = { width, height };
    this.buffer = null;
    if (this.first === 0) {
      this.planes = null;
      throw new Error(`${width} x ${height}: there is no memory for pictures of this size.`);
    }
    this.renew();
    return this.planes;
  }

  // Lends the views anew where the memory has grown, which takes the earlier ones away.
  renew() {
    const { buffer } = this.exports.memory;
    if (!this.planes || this.buffer === buffer) return;
    this.buffer = buffer;
    const pixels = this.planes.width * this.planes.height;
    const plane = 4 * Math.ceil(pixels / 4);
    const view = (Type, place) => new Type(buffer, this.first + place * plane, pixels);
    Object.assign(this.planes, {
      left: view(Uint8Array, 0),
      right: view(Uint8Array, 1),
      flags: view(Uint8Array, 2),
      confidence: view(Uint8Array, 3),
      disparity: view(Uint16Array, 4),
      depth: view(Uint16Array, 6),
      sigma: view(Float32Array, 8),
      leftRaw: view(Uint8Array, 12),
      rightRaw: view(Uint8Array, 13),
    });
  }

  // Calls the module, whose memory may grow. Throws its line where the answer is that something is wrong.
  call(name, ...words) {
    const answer = this.exports[name](...words);
    this.renew();
    if (answer <= 0) throw new Error(this.message);
    return answer;
  }

  // Gives bytes with a name, which may be empty.
  give(name, bytes) {
    const letters = new TextEncoder().encode(name);
    const place = this.exports.give(letters.length, bytes.length);
    this.renew();
    const room = new Uint8Array(this.exports.memory.buffer, place, letters.length + bytes.length);
    room.set(letters);
    room.set(bytes, letters.length);
  }

  get answer() {
    return JSON.parse(this.text(this.exports.answer(), this.exports.answer_bytes()));
  }

  // Takes a calibration file.
  addFile(name, bytes) {
    this.give(name, bytes);
    this.exports.add_file();
    this.renew();
  }

  // The cameras of the calibration files. Throws the reader's line.
  cameras(unit, rectify) {
    this.call("cameras", unit, rectify);
    return this.answer;
  }

  // Makes the pictures of the raw ones. Throws the core's line.
  rectify() {
    this.call("rectify");
  }

  // What `stereo plan` says. Throws its line.
  plan(asked) {
    this.give("", new TextEncoder().encode(JSON.stringify(asked)));
    this.call("plan");
    return this.answer;
  }

  // Matches; the milliseconds. Deviations are told of a row alone, or of all, and confidences if they are
  // asked for. Throws the core's line.
  run(sigmaRow = -1, isConfidence = true) {
    const time = this.exports.run(sigmaRow, Number(isConfidence));
    this.renew();
    if (time < 0) throw new Error(this.message);
    return time;
  }

  // Tells depth. Throws the core's line.
  depth(focalPx, baselineM, offsetPx) {
    this.call("depth", focalPx, baselineM, offsetPx);
  }
}
