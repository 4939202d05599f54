// What is opened: pairs, what moves, calibration files. Of two openings the later one counts, whichever is
// ready first.

// Numbers requests of a kind: each is told by a function whether none came after it.
function requests() {
  let last = 0;
  return () => {
    last += 1;
    const mine = last;
    return () => mine === last;
  };
}
const beginOpening = requests();
const beginCalibration = requests();

// Takes calibration files, for the pair that is there and those that follow.
async function calibrate(files) {
  const isLast = beginCalibration();
  try {
    if (await takeCalibration(files, isLast)) readAgain();
  } catch (error) {
    if (isLast()) complain(error);
  }
}

// Takes a pair, which is a promise of one; what is wrong with it is said.
async function take(promised, rig = null, isLast = beginOpening()) {
  stopMoving();
  try {
    const pair = await promised;
    if (!isLast()) return;
    state.fault = null;
    if (rig) forgetCalibration();
    put(pair);
    cloud.reset();
    if (!calibration.told) setRig(rig);
    namePair();
    takePreset();
    run();
  } catch (error) {
    if (isLast()) complain(error);
  }
}

// Takes a pair of the page's own.
async function takeGiven({ left, right, rig, disparities }) {
  setValue(CONTROLS[at("disparities")], disparities);
  const pictures = Promise.all([left, right].map(decodeUrl));
  await take(pictures.then(([a, b]) => ({ left: a, right: b, isOne: false })), rig);
}

// Takes a frame of what moves. The first one of a size tells the noise.
function takeFrame(pair) {
  const isFirst = state.pair?.of !== pair.of;
  if (isFirst) state.fault = null;
  put(pair);
  if (isFirst) {
    if (!calibration.told) setRig(null);
    namePair();
    takePreset();
  }
  run();
}

const moving = new Moving(takeFrame, (error) => {
  stopMoving();
  complain(error);
});

// Stops what moves, whose last frame stays.
function stopMoving() {
  moving.stop();
  sayMoving(false);
  finishFrame();
}

// Tells all of the frame that stays: while it moved, only what was looked at.
function finishFrame() {
  if (state.isPart) run();
}

// What changes with every frame is not read out.
function sayMoving(isMoving) {
  byId("stop").hidden = !isMoving;
  for (const id of ["pixel", "figures"]) byId(id).setAttribute("aria-live", isMoving ? "off" : "polite");
}

// Begins what moves, by a function that is told whether this opening is the last one.
async function move(begin, isLast = beginOpening()) {
  try {
    const begun = begin(isLast);
    finishFrame();
    complain(null);
    await begun;
    if (isLast()) sayMoving(true);
  } catch (error) {
    // Another opening has ended what this one began.
    if (!isLast()) return;
    stopMoving();
    complain(error);
  }
}

// Looks through two cameras, those that are chosen, or the first two.
async function lookThroughTwo(isLast) {
  const cameras = await moving.cameras(isLast);
  const lists = ["camera-left", "camera-right"].map(byId);
  lists.forEach((list, i) => {
    const chosen = cameras.findIndex(({ id }) => id === list.value);
    const options = cameras.map(({ id, name }) => make("option", { value: id }, name));
    list.replaceChildren(...options);
    list.selectedIndex = chosen < 0 ? Math.min(i, cameras.length - 1) : chosen;
  });
  if (cameras.length < 2) {
    throw new Error("There is one camera: two are needed, or one that has both pictures side by side.");
  }
  byId("camera-lists").hidden = false;
  await moving.lookThroughTwo(lists.map((list) => cameras[list.selectedIndex]), isLast);
}
