// What hands do: files, the cursor, turning, copying.

function openFiles(files) {
  if (!state.core || files.length === 0) return;
  const isVideo = files.length === 1 && files[0].type.startsWith("video/");
  if (isVideo) move(moving.play(files[0]));
  else take(openPair([...files]));
}

// Shows a text to be copied, and copies it where the browser lets the page.
async function copy(words) {
  if (!state.settings) return;
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
  for (const id of ["pick-one", "pick-two", "pick-video"]) {
    byId(id).addEventListener("change", ({ target }) => {
      openFiles(target.files);
      target.value = "";
    });
  }
  byId("camera").addEventListener("click", () => state.core && move(moving.look()));
  byId("stop").addEventListener("click", stopMoving);
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
