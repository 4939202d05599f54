// What hands do: files, the cursor, turning, copying.

// Takes files: calibrations, and a video, a pair, or a sequence; of pictures that are all by themselves each
// has both side by side.
async function openFiles(files, isEachOne = false) {
  if (!state.core || files.length === 0) return;
  const calibrations = [...files].filter(isCalibration);
  const others = [...files].filter((file) => !isCalibration(file));
  if (others.length === 0) {
    await calibrate(calibrations);
    return;
  }
  const isLast = beginOpening();
  if (calibrations.length > 0) {
    const isLastCalibration = beginCalibration();
    await takeCalibration(calibrations, () => isLast() && isLastCalibration());
    if (!isLast()) return;
  }
  if (others.length === 1 && others[0].type.startsWith("video/")) {
    await move(() => moving.play(others[0], isLast), isLast);
  } else if (others.length > (isEachOne ? 1 : 2)) {
    await move(() => moving.playPictures(others, isEachOne, isLast), isLast);
  } else {
    await take(openPair(others), null, isLast);
  }
}

// Shows a text to be copied, and copies it where the browser lets the page.
async function copy(words) {
  if (!state.settings || !state.planes) return;
  const area = byId("copied");
  area.value = words(state);
  area.select();
  try {
    await navigator.clipboard.writeText(area.value);
  } catch {
    // It is selected, and one copies it oneself.
  }
}

function listen() {
  for (const id of ["pick-one", "pick-two", "pick-video", "pick-calibration"]) {
    byId(id).addEventListener("change", ({ target }) => {
      openFiles(target.files, id === "pick-one");
      target.value = "";
    });
  }
  byId("camera").addEventListener("click", () => state.core && move((isLast) => moving.look(isLast)));
  byId("cameras").addEventListener("click", () => state.core && move(lookThroughTwo));
  for (const id of ["camera-left", "camera-right"]) {
    byId(id).addEventListener("change", () => state.core && move(lookThroughTwo));
  }
  byId("stop").addEventListener("click", () => {
    // What is about to begin is given up too.
    beginOpening();
    stopMoving();
  });
  byId("scene").addEventListener("click", () => state.core && takeGiven(DATA.scene));
  byId("restore").addEventListener("click", () => {
    takePreset();
    later();
  });
  const dropping = (isOver) => (event) => {
    event.preventDefault();
    document.body.classList.toggle("dropping", isOver);
  };
  document.addEventListener("dragover", dropping(true));
  document.addEventListener("dragleave", dropping(false));
  document.addEventListener("drop", (event) => {
    dropping(false)(event);
    openFiles(event.dataTransfer.files);
  });
  listenToPicture();
  byId("copy-command").addEventListener("click", () => copy(asCommand));
  byId("copy-rust").addEventListener("click", () => copy(asRust));
  byId("copy-c").addEventListener("click", () => copy(asC));
}
