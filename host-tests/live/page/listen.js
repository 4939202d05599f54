// What hands do: files, the cursor, turning, copying.

function openFiles(files) {
  if (!state.core || files.length === 0) return;
  const isVideo = files.length === 1 && files[0].type.startsWith("video/");
  if (isVideo) move(moving.play(files[0]));
  else take(openPair([...files]));
}

// The pixel under the pointer.
function moveTo(event) {
  const box = canvas.getBoundingClientRect();
  const inside = (value, most) => Math.min(Math.max(Math.floor(value), 0), most - 1);
  cursor.x = inside(((event.clientX - box.left) / box.width) * canvas.width, canvas.width);
  cursor.y = inside(((event.clientY - box.top) / box.height) * canvas.height, canvas.height);
  tellPixel();
}

function tellPixel() {
  isPointed = true;
  if (state.settings) byId("pixel").textContent = describePixel(state, cursor.x, cursor.y);
}

// Turns on and on, until it is stopped.
function keepTurning() {
  if (!isTurning || view() !== "points") return;
  cloud.turn(0.02, 0);
  show();
  requestAnimationFrame(keepTurning);
}

function keyInCloud(key) {
  const turns = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] };
  const factors = { "+": 1.2, "=": 1.2, "-": 1 / 1.2 };
  if (key === " ") {
    isTurning = !isTurning;
    keepTurning();
    return true;
  }
  if (turns[key]) cloud.turn(...turns[key]);
  else if (factors[key]) cloud.comeNearer(factors[key]);
  else return false;
  show();
  return true;
}

function keyInPicture(key, isFar) {
  const moves = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  if (!moves[key]) return false;
  const [x, y] = moves[key].map((step) => (isFar ? 10 : 1) * step);
  cursor.x = Math.min(Math.max(cursor.x + x, 0), canvas.width - 1);
  cursor.y = Math.min(Math.max(cursor.y + y, 0), canvas.height - 1);
  tellPixel();
  return true;
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
  canvas.addEventListener("pointermove", (event) => {
    if (view() !== "points") moveTo(event);
    else if (event.buttons !== 0) {
      cloud.turn(event.movementX / 150, event.movementY / 150);
      show();
    }
  });
  canvas.addEventListener("wheel", (event) => {
    if (view() !== "points") return;
    event.preventDefault();
    cloud.comeNearer(Math.exp(-event.deltaY / 500));
    show();
  }, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    if (!state.settings || event.ctrlKey || event.altKey || event.metaKey) return;
    const isCloud = view() === "points";
    if (isCloud ? keyInCloud(event.key) : keyInPicture(event.key, event.shiftKey)) event.preventDefault();
  });
  byId("copy-command").addEventListener("click", () => copy(asCommand));
  byId("copy-rust").addEventListener("click", () => copy(asRust));
  byId("copy-c").addEventListener("click", () => copy(asC));
}
