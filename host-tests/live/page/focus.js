// The focus report's own script: a stack's answers in the views, as far as its sliders let them through.

const MOST_SURE = 255;

const frameWords = (steps) => `frame ${(steps / DATA.frame_steps).toFixed(1)}`;
// Three digits, which is what a focus sweep tells at best.
const metresOf = (steps) => `${Number((steps * DATA.depth_step_m).toPrecision(3))} m`;

// The numbers of the stack: frames from 1, in parts, confidences, and depths in steps.
async function decodeStack() {
  const decoded = async (name, url) => url && decodeUrl({ name, url });
  const urls = [[DATA.name, byId("all-in-focus").src], ["data", DATA.answers], ["data", DATA.depths]];
  const [picture, answers, depths] = await Promise.all(urls.map(([name, url]) => decoded(name, url)));
  const { width, height } = answers;
  const planes = { width, height, disparity: numbersOf(answers), confidence: bytesOf(answers),
    depth: depths ? numbersOf(depths) : new Uint16Array(width * height) };
  return { picture, planes };
}

let stack = null;
const SLIDERS = [
  { name: "least", label: "Least confidence", min: 0, max: MOST_SURE,
    say: (value) => (value === 0 ? "off" : (value / MOST_SURE).toFixed(2)) },
  { name: "first", label: "First frame that is shown", say: frameWords },
  { name: "last", label: "Last frame that is shown", say: frameWords },
];

// Leaves out what the sliders keep back, and says what is left.
function sift() {
  const [least, first, last] = SLIDERS.map(valueOf);
  const { disparity: frames, depth, confidence } = stack.planes;
  const isShown = (i) => frames[i] !== NO_ANSWER && confidence[i] >= least && frames[i] >= first
    && frames[i] <= last;
  state.planes = { ...stack.planes, disparity: frames.map((frame, i) => (isShown(i) ? frame : NO_ANSWER)),
    depth: depth.map((steps, i) => (isShown(i) ? steps : 0)),
    confidence: confidence.map((sure, i) => (isShown(i) ? sure : 0)) };
  cloud.forget();
  const shown = state.planes.disparity.reduce((sum, frame) => sum + Number(frame !== NO_ANSWER), 0);
  const share = ((100 * shown) / frames.length).toFixed(1);
  byId("figures").textContent = `${share} % of the pixels have an answer that is shown.`;
  show();
  if (isPointed) tellPixel();
}

const sharpest = PAINT.left;
PAINT["all in focus"] = (...given) => {
  sharpest(...given);
  return ["Each pixel as in the frame in which it is sharpest."];
};
PAINT["sharpest frame"] = (words, { planes }) => {
  const found = paintNumbers(words, planes.disparity, NO_ANSWER, true);
  return found ? rampLegend(found.map(frameWords)) : [NO_ANSWERS];
};
PAINT.confidence = (words, { planes }) => {
  for (let i = 0; i < words.length; i += 1) {
    words[i] = planes.confidence[i] === 0 ? BLACK : RAMP_WORDS[planes.confidence[i]];
  }
  return rampLegend(["0", "1"]);
};
PAINT.depth = (words, { planes }) => {
  const found = paintNumbers(words, planes.depth, 0, false);
  return found ? rampLegend(found.reverse().map(metresOf)) : [NO_DISTANCE];
};

// What is known of a pixel, in one line.
function describeFocus(state, x, y) {
  const planes = state.whole;
  const pixel = y * planes.width + x;
  const place = placeWords(state, x, y);
  if (planes.disparity[pixel] === NO_ANSWER) return `${place}no answer`;
  const depth = planes.depth[pixel] > 0 ? `; depth ${metresOf(planes.depth[pixel])}` : "";
  const frame = (planes.disparity[pixel] / DATA.frame_steps).toFixed(2);
  return `${place}sharpest in frame ${frame}${depth}; confidence `
    + `${(planes.confidence[pixel] / MOST_SURE).toFixed(2)}`;
}

// The numbers that the sliders run over, and where they begin: all is shown.
function addSliders() {
  let [low, high] = [NO_ANSWER, 0];
  for (const frame of stack.planes.disparity) {
    if (frame !== NO_ANSWER) [low, high] = [Math.min(low, frame), Math.max(high, frame)];
  }
  low = Math.min(low, high);
  [0, low, high].forEach((start, i) => {
    const slider = SLIDERS[i];
    const control = Object.assign(slider, { min: slider.min ?? low, max: slider.max ?? high });
    addControl(byId("sift"), control, sift);
    setValue(control, start);
  });
}

async function begin() {
  stack = await decodeStack();
  const { picture, planes } = stack;
  Object.assign(state, { pair: { left: picture }, whole: planes, rig: { focal_px: DATA.focal_px },
    hasDepth: DATA.focal_px !== null, ratio: ratioTo(planes), describe: describeFocus,
    depthAt: ({ planes: { depth } }, pixel) => depth[pixel] * DATA.depth_step_m });
  addViews(["all in focus", "sharpest frame", "confidence", ...(DATA.depths ? ["depth"] : []),
    ...(state.hasDepth ? ["points"] : [])], "sharpest frame");
  fitPicture(planes.width, planes.height);
  listenToPicture();
  addSliders();
  sift();
}

begin();
