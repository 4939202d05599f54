// Pictures that move: a video file or a camera that has both pictures side by side, two cameras, or the
// pictures of a sequence, frame by frame.

// One video and the canvas that its frames are read from.
class Eye {
  constructor() {
    this.video = document.createElement("video");
    Object.assign(this.video, { muted: true, loop: true, playsInline: true });
    this.canvas = new OffscreenCanvas(2, 2);
    this.presented = 0;
  }

  // The pictures of a frame: one, or the two halves of it, of which an odd last column is in neither.
  frame(name, count) {
    const { videoWidth, videoHeight: height } = this.video;
    const width = Math.floor(videoWidth / count);
    if (width > MOST_SIDE || height > MOST_SIDE) {
      throw new Error(`${name}: is ${width} x ${height}; up to ${MOST_SIDE} x ${MOST_SIDE} are matched.`);
    }
    if (this.canvas.width !== count * width || this.canvas.height !== height || !this.context) {
      [this.canvas.width, this.canvas.height] = [count * width, height];
      this.context = this.canvas.getContext("2d", { willReadFrequently: true });
    }
    this.context.drawImage(this.video, 0, 0);
    const pixels = (place) => this.context.getImageData(place * width, 0, width, height).data;
    return Array.from({ length: count }, (_, place) => ({ name, width, height, pixels: pixels(place) }));
  }

  // A file plays no faster than its frames are taken, of which `presented` were ready: decoding others is in
  // vain. What a camera sees cannot wait.
  pace(presented) {
    if (this.video.srcObject) return;
    const isAhead = presented > this.presented + 1;
    this.presented = presented;
    this.video.playbackRate = Math.min(Math.max(this.video.playbackRate * (isAhead ? 0.97 : 1.005), 0.25), 1);
  }

  stop() {
    this.video.pause();
    for (const track of this.video.srcObject?.getTracks() ?? []) track.stop();
    this.video.srcObject = null;
    this.video.removeAttribute("src");
  }
}

// Frames that the rate is told of, at most.
const TIMED = 31;

// Pictures of a sequence are shown for as long, ms, at least; so many pairs are decoded once alone.
const LEAST_MS = 33;
const KEPT = 48;

// What is thrown for an opening that another one has overtaken, which nobody is told of.
function goOn(isLast) {
  if (!isLast()) throw new Error("Something else is opened.");
}

// What begins something is told by a function whether no other opening came after it.
class Moving {
  // `show` is given every pair; `end` is called with what went wrong, and stops it.
  constructor(show, end) {
    this.eyes = [new Eye(), new Eye()];
    [this.show, this.end, this.isOn, this.isTwo, this.times] = [show, end, false, false, []];
  }

  // Frames in a second, of the last ones that were shown: how fast all of the page is, not the matcher alone.
  get rate() {
    const spans = this.times.length - 1;
    return spans < 1 ? 0 : (1000 * spans) / (this.times[spans] - this.times[0]);
  }

  // Plays a file.
  async play(file, isLast) {
    this.stop();
    this.url = URL.createObjectURL(file);
    this.eyes[0].video.src = this.url;
    await this.begin([file.name], `${file.name}: is no picture or video that this browser reads.`, isLast);
  }

  // Shows the pictures of files, pair after pair, and again from the first one.
  async playPictures(files, isEachOne, isLast) {
    this.stop();
    const frames = isEachOne ? byName(files).map((file) => [file]) : framesOf(files);
    const kept = [await openPair(frames[0])];
    goOn(isLast);
    [this.isOn, this.times, this.names] = [true, [], frames];
    this.nextPair(frames, kept, 0);
  }

  // Shows a pair, and then the next, until it is stopped or something else begins.
  nextPair(frames, kept, place) {
    setTimeout(async () => {
      const isOver = () => !this.isOn || this.names !== frames;
      try {
        const began = performance.now();
        const pair = kept[place] ?? await openPair(frames[place]);
        if (isOver()) return;
        if (place < KEPT) kept[place] = pair;
        this.times = [...this.times.slice(1 - TIMED), performance.now()];
        this.show({ ...pair, isMoving: true, of: frames });
        const rest = Math.max(0, LEAST_MS - (performance.now() - began));
        setTimeout(() => this.nextPair(frames, kept, (place + 1) % frames.length), rest);
      } catch (error) {
        if (!isOver()) this.end(error);
      }
    });
  }

  // Takes what a camera sees that has both pictures side by side.
  async look(isLast) {
    this.stop();
    await this.open(this.eyes[0], { width: { ideal: 1280 } }, isLast);
    await this.begin(["camera"], "The camera shows nothing.", isLast);
  }

  // The cameras of this machine that the page may look through, once it was asked.
  async cameras(isLast) {
    this.stop();
    await this.open(this.eyes[0], true, isLast);
    const devices = await navigator.mediaDevices.enumerateDevices();
    goOn(isLast);
    this.stop();
    const cameras = devices.filter(({ kind }) => kind === "videoinput");
    return cameras.map(({ deviceId, label }, i) => ({ id: deviceId, name: label || `camera ${i + 1}` }));
  }

  // Takes what two cameras see, left and right.
  async lookThroughTwo(cameras, isLast) {
    this.stop();
    if (cameras[0].id === cameras[1].id) throw new Error("Left and right are one camera: choose two.");
    for (const [i, { id }] of cameras.entries()) {
      const size = { width: { ideal: 640 }, height: { ideal: 480 } };
      await this.open(this.eyes[i], { deviceId: { exact: id }, ...size }, isLast);
    }
    this.isTwo = true;
    await this.begin(cameras.map(({ name }) => name), "A camera shows nothing.", isLast);
  }

  async open(eye, video, isLast) {
    let stream;
    try {
      stream = await navigator.mediaDevices.getUserMedia({ video });
    } catch {
      throw new Error("There is no camera that this page may look through.");
    }
    if (!isLast()) stream.getTracks().forEach((track) => track.stop());
    goOn(isLast);
    eye.video.srcObject = stream;
  }

  async begin(names, fault, isLast) {
    try {
      await Promise.all(names.map((_, i) => this.eyes[i].video.play()));
    } catch {
      throw new Error(fault);
    }
    goOn(isLast);
    [this.isOn, this.times, this.names] = [true, [], names];
    this.next(names);
  }

  // Shows a frame when there is one, and then the next, until it is stopped or something else begins.
  next(names) {
    this.eyes[0].video.requestVideoFrameCallback((_, { presentedFrames }) => {
      if (!this.isOn || this.names !== names) return;
      try {
        this.eyes[0].pace(presentedFrames);
        this.times = [...this.times.slice(1 - TIMED), performance.now()];
        this.show(this.pair(names));
        this.next(names);
      } catch (error) {
        this.end(error);
      }
    });
  }

  // The pair that is seen now.
  pair(names) {
    if (!this.isTwo) {
      const [left, right] = this.eyes[0].frame(names[0], 2);
      return { left, right, isOne: true, isMoving: true, of: names };
    }
    const [left, right] = this.eyes.flatMap((eye, i) => eye.frame(names[i], 1));
    checkSizes(left, right);
    return { left, right, isOne: false, isMoving: true, of: names };
  }

  stop() {
    if (!this.eyes) return;
    [this.isOn, this.isTwo] = [false, false];
    this.eyes.forEach((eye) => eye.stop());
    if (this.url) URL.revokeObjectURL(this.url);
    this.url = null;
  }
}
