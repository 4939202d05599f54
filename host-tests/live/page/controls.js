// The controls, in the order of the module's settings, and what they say.

const OFF = -1;
const METHODS = ["fast", "block", "sgm-lean", "sgm", "sgm-edge"];
const FILTERS = ["dense", "default", "strict"];
const NOISES = ["none", "low", "high"];
const CHECKS = 7;
const PENALTIES = 24;

const px = (value) => `${value} px`;
const steps = (value) => `${value / 32} px`;
const offOr = (say) => (value) => (value === OFF ? "off" : say(value));
const anyOr = (say) => (value) => (value === OFF ? "any" : say(value));
const noneOr = (say) => (value) => (value === 0 ? "off" : say(value));
const pixels = (value) => `${value} pixels`;
const grey = (value) => `${value} grey levels`;

// name, label, then what a slider runs over and says; a list's words; or nothing more for a switch.
const CONTROLS = [
  { name: "method", label: "Method", words: METHODS, start: 3 },
  { name: "filter", label: "Filter", words: FILTERS, start: 1 },
  { name: "noise", label: "Noise of the cameras", words: ["auto", ...NOISES], start: 0 },
  { name: "disparities", label: "Disparities", min: 16, max: 256, step: 16, start: 64, say: px },
  { name: "min_disparity", label: "Least disparity", min: 0, max: 256, start: 0, say: px },
  { name: "min_confidence", label: "Least confidence", min: 0, max: 207, start: 0, say: noneOr(String) },
  { name: "balance", label: "Exposures balanced", words: ["none", "auto"], start: 1 },
  { name: "left_right_px", label: "Left-right check", min: OFF, max: 16, say: offOr(px) },
  { name: "uniqueness_percent", label: "Uniqueness", min: OFF, max: 99, say: offOr((v) => `${v} %`) },
  { name: "refuse_flat", label: "Refuse flat minima" },
  { name: "texture_gradient", label: "Texture: gradient", min: 0, max: 64, say: grey },
  { name: "texture_pixels", label: "Texture: pixels of a window", min: 0, max: 81, say: noneOr(pixels) },
  { name: "refuse_ceiling", label: "Refuse the largest disparity" },
  { name: "surface_step", label: "Step within a surface", min: 0, max: 32, say: steps },
  { name: "smoothing_radius", label: "Smoothing", min: 0, max: 8, say: noneOr(pixels) },
  { name: "speckle_pixels", label: "Speckle: least surface", min: 0, max: 255, say: noneOr(pixels) },
  { name: "speckle_run", label: "Speckle: most of one row", min: 0, max: 255, say: noneOr(pixels) },
  { name: "median", label: "Median of 3 x 3" },
  { name: "fill_pixels", label: "Fill gaps up to", min: 0, max: 255, say: noneOr(pixels) },
  { name: "fill_step", label: "Fill: sides differ by up to", min: OFF, max: 320, say: anyOr(steps) },
  { name: "fattening_slope", label: "Fattening: slope", min: OFF, max: 512, say: offOr(steps) },
  { name: "open_run", label: "Open: most of one row", min: 0, max: 255, say: noneOr(pixels) },
  { name: "open_margin", label: "Open: margin", min: 0, max: 128, say: noneOr(String) },
  { name: "refuse_repeats", label: "Refuse repeated patterns" },
  { name: "gradient", label: "Gradients cut off at", min: 1, max: 14, say: String },
  { name: "cost", label: "Cost cut off at", min: 1, max: 84, say: String },
  { name: "step[0]", label: "Step of 1 px", min: 1, max: 96, say: String },
  { name: "step[1]", label: "Step of 1 px at an edge", min: 1, max: 96, say: String },
  { name: "jump[0]", label: "Jump", min: 1, max: 124, say: String },
  { name: "jump[1]", label: "Jump at an edge", min: 1, max: 124, say: String },
  { name: "jump[2]", label: "Jump at a strong edge", min: 1, max: 124, say: String },
  { name: "edges[0]", label: "An edge differs by", min: 0, max: 255, say: grey },
  { name: "edges[1]", label: "A strong edge differs by", min: 0, max: 255, say: grey },
];

// The cameras, which are no settings of the matcher.
const RIG = [
  { name: "focal_px", label: "Focal length, px", step: "any" },
  { name: "baseline_mm", label: "Baseline, mm", step: "any" },
  { name: "offset_px", label: "Offset of principal points, px", step: "any" },
];

// Whether a list of the page stands at its first word.
const isOff = (name) => byId(name).value === "0";

// The index of a control among the settings.
const at = (name) => CONTROLS.findIndex((control) => control.name === name);

function addControls(changed) {
  const places = (index) => (index < CHECKS ? "search" : index < PENALTIES ? "checks" : "penalties");
  CONTROLS.forEach((control, index) => {
    addControl(byId(places(index)), control, changed);
    if (control.start !== undefined) setValue(control, control.start);
  });
  RIG.forEach((control) => addControl(byId("rig"), control, changed));
}
