// Calibration files: read by the module as the program reads them, and pairs rectified by them.

const UNITS = ["as the file says", "m", "cm", "mm"];
const UNIT = { name: "unit", label: "Lengths of OpenCV's file", words: UNITS, start: 0 };
const RECTIFY = { name: "rectify", label: "Rectify the pair" };
const BY_FILES = 2;

// What was read: the files' names, what they say, and whether a pair of another size asks for it anew.
const calibration = { names: [], told: null, isDue: false, isTyped: false };

const isCalibration = ({ name }) => /\.(txt|ya?ml|xml|json|bin|rec)$/i.test(name);

function addCalibrationControls(changed) {
  for (const control of [UNIT, RECTIFY]) addControl(byId("rig"), control, changed);
  setValue(UNIT, UNIT.start);
  forgetCalibration();
}

// No file says anything of the cameras any more.
function forgetCalibration() {
  state.core?.exports.clear_files();
  Object.assign(calibration, { names: [], told: null, isDue: false, isTyped: false });
  setCentre(null);
  byId("calibration").textContent = "";
}

// The files say nothing of the pair that is there; they may of another one, or in another unit.
function leaveCalibration() {
  calibration.told = null;
  setCentre(null);
  byId("calibration").textContent = `${calibration.names.join(", ")}: not used`;
}

// The pixel where the cameras' axis is, which is known of the page's own pairs and by a calibration alone.
function setCentre(centre) {
  state.rig.centre_px = centre ?? undefined;
  if (centre) return;
  RECTIFY.input.disabled = true;
  setValue(RECTIFY, 0);
}

// Gives the files to the module, unless they are not wanted any more once they are read, and says whether it
// did; they are in the order of their names, left before right.
async function takeCalibration(files, isWanted) {
  const sorted = [...files].sort((a, b) => a.name.localeCompare(b.name, "en", { numeric: true }));
  const all = await Promise.all(sorted.map(async (file) => new Uint8Array(await file.arrayBuffer())));
  if (!isWanted()) return false;
  forgetCalibration();
  sorted.forEach(({ name }, i) => state.core.addFile(name, all[i]));
  Object.assign(calibration, { names: sorted.map(({ name }) => name), isDue: true });
  return true;
}

// Reads the files for the pair's size. Throws the module's line.
function readCalibration(rectify) {
  calibration.isDue = false;
  const told = state.core.cameras(valueOf(UNIT), rectify);
  Object.assign(calibration, { told, isTyped: false });
  RIG.forEach(({ name, input }) => (input.value = told[name]));
  setCentre(told.centre_px);
  state.isRigGiven = true;
  RECTIFY.input.disabled = !(told.may_rectify && told.may_leave);
  setValue(RECTIFY, Number(told.is_rectified));
  byId("calibration").textContent = `${calibration.names.join(", ")}: ${told.format}, `
    + (told.is_rectified ? "by which the pair is rectified" : "of rectified pictures");
}

// A pair as the module rectifies it: the grey values that are matched, and the colours that are shown. What
// moves is shown in grey, for colours take three times as long.
function rectified(pair) {
  const { core } = state;
  const sides = ["left", "right"];
  const shown = sides.map((side) => new Uint8ClampedArray(pair[side].pixels.length).fill(255));
  const put = (channels) => sides.forEach((side, i) => {
    const plane = core.planes[side];
    for (const channel of channels) {
      for (let p = 0, at = channel; p < plane.length; p += 1, at += 4) shown[i][at] = plane[p];
    }
  });
  for (const channel of pair.isMoving ? [] : [0, 1, 2]) {
    for (const side of sides) {
      const { pixels } = pair[side];
      const plane = core.planes[`${side}Raw`];
      for (let p = 0, at = channel; p < plane.length; p += 1, at += 4) plane[p] = pixels[at];
    }
    core.rectify();
    put([channel]);
  }
  for (const side of sides) toGrey(pair[side], core.planes[`${side}Raw`]);
  core.rectify();
  if (pair.isMoving) put([0, 1, 2]);
  const [left, right] = sides.map((side, i) => ({ ...pair[side], pixels: shown[i] }));
  return { ...pair, left, right };
}

// The options of the program that read the same files; none once cameras were typed, unless the pair is
// rectified by the files, beside which the program takes no numbers.
function calibrationWords() {
  const { names, told } = calibration;
  if (!told || (calibration.isTyped && !told.is_rectified)) return null;
  const files = names.map((name) => `--calib ${quoted(name)}`);
  const unit = valueOf(UNIT) > 0 ? [`--unit ${UNITS[valueOf(UNIT)]}`] : [];
  return [...files, ...(told.is_rectified ? ["--rectify"] : []), ...unit].join(" ");
}
