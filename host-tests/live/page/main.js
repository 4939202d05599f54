// The page: what is opened is matched with what the controls say, and shown.

Object.assign(state,
  { core: null, settings: null, preset: null, noise: "none", isRigGiven: false, isPart: false, timeMs: 0,
    fault: null });
let measured = 0;
let isDue = false;
let toldAt = 0;
const BETWEEN_FIGURES_MS = 500;

// Says what is wrong, in a line; nothing when all is well.
function complain(error) {
  byId("message").textContent = error ? error.message : "";
}

// The settings of the controls into the module. `auto` noise is what was measured; exposures count for
// methods that compare brightness.
function writeSettings() {
  const { core } = state;
  CONTROLS.forEach((control, i) => {
    core.settings[i] = valueOf(control);
  });
  const chosen = valueOf(CONTROLS[at("noise")]);
  core.settings[at("noise")] = chosen === 0 ? measured : chosen - 1;
  core.settings[at("balance")] = Number(!isOff("balance") && core.settings[at("method")] >= 2);
  // Of what moves, the first frame was measured.
  state.noise = chosen === 0 && !state.pair?.isMoving ? "auto" : NOISES[core.settings[at("noise")]];
}

// Measures the noise of the pair as the method sees it.
function measure() {
  writeSettings();
  state.core.exports.measure();
  measured = state.core.settings[at("noise")];
  writeSettings();
}

// Moves the checks and the penalties to those of method, filter and noise.
function takePreset() {
  if (state.planes) measure();
  writeSettings();
  state.core.exports.preset();
  state.preset = Int32Array.from(state.core.settings);
  CONTROLS.forEach((control, i) => i >= CHECKS && setValue(control, state.preset[i]));
}

// Matches with what the controls say, and shows it.
function run() {
  isDue = false;
  if (!state.planes) return;
  try {
    writeSettings();
    state.settings = Int32Array.from(state.core.settings);
    const wrong = match();
    complain(state.fault ?? wrong);
  } catch (error) {
    complain(error);
    return;
  }
  show();
  if (isPointed && (!moving.isOn || isWatched())) tellPixel();
  // Of what moves, figures that can be read.
  if (moving.isOn && performance.now() - toldAt < BETWEEN_FIGURES_MS) return;
  toldAt = performance.now();
  tellFigures();
}

// Matches, with all that may be looked at. Of what moves that is what is looked at now: deviations of all
// pixels take a third of a frame's time, and confidences another one. What is wrong with the cameras, which
// the other views do without.
function match() {
  const isSeen = (...views) => !moving.isOn || isWatched() || views.includes(view());
  state.isPart = moving.isOn;
  state.timeMs = state.core.run(moving.isOn ? cursor.y : -1, isSeen("confidence"));
  cloud.forget();
  return isSeen("depth", "points") ? tellDepth() : null;
}

// Says how long the frame took, and what it has.
function tellFigures() {
  markOthers();
  const { disparity } = state.planes;
  let answers = 0;
  for (let i = 0; i < disparity.length; i += 1) answers += disparity[i] === NO_ANSWER ? 0 : 1;
  const share = ((100 * answers) / disparity.length).toFixed(1);
  const noise = isOff("noise") ? `, noise ${NOISES[measured]} as measured` : "";
  const rate = `${(1000 / state.timeMs).toFixed(0)} a second, kernel ${state.core.kernel}`;
  const shown = moving.isOn && moving.rate > 0
    ? `; ${moving.rate.toFixed(0)} frames a second are shown` : "";
  byId("figures").textContent = `${state.timeMs.toFixed(1)} ms a frame on one thread of this machine `
    + `(${rate}); ${share} % answered${noise}${shown}.`;
  showWork(state);
}

// Marks the checks and penalties that are not the filter's.
function markOthers() {
  const other = others(state.settings, state.preset);
  CONTROLS.forEach((control, i) => control.row.classList.toggle("other", other.includes(i)));
  byId("restore").disabled = other.length === 0;
}

// Tells the depths by the fields of the cameras; what is wrong with those, or null.
function tellDepth() {
  for (const { name, input } of RIG) state.rig[name] = Number(input.value);
  const { focal_px: focal, baseline_mm: baseline, offset_px: offset } = state.rig;
  state.hasDepth = focal > 0 && baseline > 0;
  cloud.forget();
  if (!state.hasDepth) return null;
  try {
    state.core.depth(focal, baseline / 1000, offset);
    return null;
  } catch (error) {
    state.hasDepth = false;
    return error;
  }
}

// Runs once for all that happens before the next picture.
function later() {
  if (isDue) return;
  isDue = true;
  requestAnimationFrame(() => isDue && run());
}

function changed(control) {
  if (!state.core) return;
  if (["method", "filter", "noise", "balance"].includes(control.name)) takePreset();
  if (control === UNIT || control === RECTIFY) {
    readAgain(control === RECTIFY ? valueOf(RECTIFY) : BY_FILES);
    return;
  }
  if (RIG.includes(control)) {
    state.isRigGiven = false;
    calibration.isTyped = true;
    complain(tellDepth());
    show();
    return;
  }
  later();
}

// Takes a pair: its pictures into the module's planes, of another size if need be, rectified if a calibration
// says so. What is wrong with that is a fault of the pair, which is matched without it.
function put(pair, rectify = BY_FILES) {
  const { width, height } = pair.left;
  if (state.planes?.width !== width || state.planes?.height !== height) {
    // The module frees those that there are before it looks for room.
    state.planes = null;
    forgetPicture();
    state.planes = state.core.begin(width, height);
    fitPicture(width, height);
    calibration.isDue = calibration.names.length > 0;
  }
  state.raw = pair;
  try {
    if (calibration.isDue) readCalibration(rectify);
    state.pair = calibration.told?.is_rectified ? rectified(pair) : pair;
  } catch (error) {
    leaveCalibration();
    setRig(null);
    [state.fault, state.pair] = [error, pair];
  }
  if (calibration.told?.is_rectified) return;
  toGrey(pair.left, state.planes.left);
  toGrey(pair.right, state.planes.right);
}

// Reads the calibration's files anew for the pair that is there, which is matched.
function readAgain(rectify = BY_FILES) {
  if (!state.raw) return;
  state.fault = null;
  calibration.isDue = calibration.names.length > 0;
  put(state.raw, rectify);
  cloud.reset();
  takePreset();
  run();
}

// Says what is matched.
function namePair() {
  const { left, right, isOne, of } = state.pair;
  const count = Array.isArray(of?.[0]) ? `${of.length} pairs from ` : "";
  const names = count + (isOne ? `${left.name}, side by side` : `${left.name}, ${right.name}`);
  byId("pair-names").textContent = `${names}: ${left.width} x ${left.height}`;
}

// The cameras of the page's own pairs; without any, those that were typed stay, and theirs go: another pair's
// depths would be wrong.
function setRig(rig) {
  if (rig || state.isRigGiven) RIG.forEach(({ name, input }) => (input.value = rig?.[name] ?? ""));
  setCentre(rig?.centre_px);
  state.isRigGiven = rig !== null;
}

async function begin() {
  addControls(changed);
  addCalibrationControls(changed);
  addPlan();
  addViews(VIEWS);
  listen();
  try {
    state.core = await Core.load(MODULE);
    tellPlan();
    await takeGiven(DATA.given ?? DATA.scene);
  } catch (error) {
    complain(error);
  }
}

begin();
