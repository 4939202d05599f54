// Pictures that move: a video file or a camera that has both pictures side by side, frame by frame.

class Moving {
  // `show` is given every pair; `end` is called with what went wrong, or nothing.
  constructor(show, end) {
    this.video = document.createElement("video");
    Object.assign(this.video, { muted: true, loop: true, playsInline: true });
    this.canvas = new OffscreenCanvas(2, 2);
    [this.show, this.end, this.isOn] = [show, end, false];
  }

  // Plays a file.
  async play(file) {
    this.stop();
    this.url = URL.createObjectURL(file);
    this.video.src = this.url;
    await this.begin(file.name, `${file.name}: is no picture or video that this browser reads.`);
  }

  // Takes what the machine's camera sees.
  async look() {
    this.stop();
    try {
      this.video.srcObject = await navigator.mediaDevices.getUserMedia({ video: { width: { ideal: 1280 } } });
    } catch {
      throw new Error("There is no camera that this page may look through.");
    }
    await this.begin("camera", "The camera shows nothing.");
  }

  async begin(name, fault) {
    try {
      await this.video.play();
    } catch {
      this.stop();
      throw new Error(fault);
    }
    this.isOn = true;
    this.next(name);
  }

  // Shows a frame when there is one, and then the next.
  next(name) {
    this.video.requestVideoFrameCallback(() => {
      if (!this.isOn) return;
      try {
        this.show(this.frame(name));
        this.next(name);
      } catch (error) {
        this.stop();
        this.end(error);
      }
    });
  }

  // The pair of a frame: an odd last column is of neither picture.
  frame(name) {
    const { videoWidth, videoHeight: height } = this.video;
    const width = videoWidth - (videoWidth % 2);
    if (this.canvas.width !== width || this.canvas.height !== height) {
      [this.canvas.width, this.canvas.height] = [width, height];
      this.context = this.canvas.getContext("2d", { willReadFrequently: true });
    }
    this.context.drawImage(this.video, 0, 0);
    const { data } = this.context.getImageData(0, 0, width, height);
    const [left, right] = halves({ name, width, height, pixels: data });
    return { left, right, isOne: true, isMoving: true };
  }

  stop() {
    if (!this.video) return;
    this.isOn = false;
    this.video.pause();
    for (const track of this.video.srcObject?.getTracks() ?? []) track.stop();
    this.video.srcObject = null;
    this.video.removeAttribute("src");
    if (this.url) URL.revokeObjectURL(this.url);
    this.url = null;
  }
}
