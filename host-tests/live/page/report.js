// The report's own script: a run's data in the views, as far as its sliders let them through.

const MOST_ERROR_PX = 3;

// The numbers of the run.
async function decodeRun() {
  const decoded = async (name, url) => url && decodeUrl({ name, url });
  const urls = [byId("left-image").src, byId("right-image").src, DATA.answers, DATA.notes, DATA.truth];
  const all = await Promise.all(urls.map((url, i) => decoded(DATA.names[i] ?? "data", url)));
  const [left, right, answers, notes, truth] = all;
  const { width, height } = answers;
  const planes = { width, height, left: new Uint8Array(width * height), disparity: numbersOf(answers),
    confidence: bytesOf(answers), flags: bytesOf(notes),
    sigma: Float32Array.from(numbersOf(notes), (n) => n / 1024) };
  toGrey(left, planes.left);
  return { pair: { left, right }, planes, truth: truth ? numbersOf(truth) : null,
    isBad: truth ? bytesOf(truth) : null };
}

function distance(steps) {
  const px = `${(steps / STEPS_PX).toFixed(1)} px`;
  if (!DATA.rig) return px;
  const metres = depthOf(steps, DATA.rig);
  return `${metres === Infinity ? "infinity" : `${metres.toFixed(metres < 100 ? 2 : 0)} m`} (${px})`;
}

const offAtZero = (value) => (value === 0 ? "off" : String(value));

let whole = null;
const SLIDERS = [
  { name: "least", label: "Least confidence", min: 0, max: DATA.most_confidence, say: offAtZero },
  { name: "near", label: "Nearest that is shown", say: distance },
  { name: "far", label: "Farthest that is shown", say: distance },
];

// Leaves out what the sliders keep back, and says what is left.
function sift() {
  const [least, near, far] = SLIDERS.map(valueOf);
  const { disparity, confidence } = whole.planes;
  const isShown = (d, i) => d !== NO_ANSWER && confidence[i] >= least && d <= near && d >= far;
  state.planes = { ...whole.planes,
    disparity: disparity.map((d, i) => (isShown(d, i) ? d : NO_ANSWER)),
    confidence: confidence.map((c, i) => (isShown(disparity[i], i) ? c : 0)) };
  cloud.forget();
  let [shown, judged, bad] = [0, 0, 0];
  state.planes.disparity.forEach((d, i) => {
    if (d === NO_ANSWER) return;
    shown += 1;
    if (!whole.truth || whole.truth[i] === NO_ANSWER) return;
    judged += 1;
    bad += whole.isBad[i];
  });
  const percent = (part, all) => `${((100 * part) / Math.max(all, 1)).toFixed(2)} %`;
  const beside = whole.truth ? `, ${percent(bad, judged)} of them over 2 px off where both cameras see` : "";
  byId("figures").textContent = `${percent(shown, disparity.length)} of the pixels have an answer that is `
    + `shown${beside}.`;
  show();
  if (isPointed) tellPixel();
}

// The true disparities, in steps, in the colours of the answers.
PAINT.truth = (words) => {
  const found = paintNumbers(words, whole.truth, NO_ANSWER, true);
  return found ? rampLegend(found.map((raw) => `${(raw / STEPS_PX).toFixed(1)} px`)) : ["No truth."];
};

// Answer minus truth: blue is too far, orange too near.
PAINT.error = (words, { planes }) => {
  const mix = (a, b, t) => a.map((c, i) => Math.round(c + t * (b[i] - c)));
  const [far, right, near] = DATA.errors;
  planes.disparity.forEach((d, i) => {
    const t = (d - whole.truth[i]) / STEPS_PX / MOST_ERROR_PX;
    const isKnown = d !== NO_ANSWER && whole.truth[i] !== NO_ANSWER;
    words[i] = isKnown ? packed(mix(right, t < 0 ? far : near, Math.min(Math.abs(t), 1))) : BLACK;
  });
  return [swatch(far, `${MOST_ERROR_PX} px too far`), swatch(right, "right"),
    swatch(near, `${MOST_ERROR_PX} px too near`), "black: no answer, or hidden from the right camera"];
};

// The numbers that the sliders run over, and where they begin: all is shown.
function addSliders() {
  let [low, high] = [NO_ANSWER, 0];
  for (const d of whole.planes.disparity) {
    if (d !== NO_ANSWER) [low, high] = [Math.min(low, d), Math.max(high, d)];
  }
  [low, high] = [Math.min(low, high), high];
  const starts = [0, high, low];
  SLIDERS.forEach((slider, i) => {
    const control = Object.assign(slider, { min: slider.min ?? low, max: slider.max ?? high });
    addControl(byId("sift"), control, sift);
    setValue(control, starts[i]);
  });
}

async function begin() {
  whole = await decodeRun();
  const { pair, planes, truth } = whole;
  Object.assign(state, { pair, whole: planes, rig: DATA.rig ?? {}, hasDepth: DATA.rig !== null,
    ratio: ratioTo(planes) });
  addViews([...VIEWS.filter((name) => state.hasDepth || !["depth", "points"].includes(name)),
    ...(truth ? ["truth", "error"] : [])]);
  fitPicture(planes.width, planes.height);
  listenToPicture();
  addSliders();
  sift();
}

begin();
