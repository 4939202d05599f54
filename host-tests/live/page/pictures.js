// Pictures from files: decoded by the browser, made grey as the core makes them.

const MOST_SIDE = 4096;

// The pixels of a picture, four bytes each. Throws a line that names it.
async function decode(blob, name) {
  let bitmap;
  try {
    bitmap = await createImageBitmap(blob, { colorSpaceConversion: "none" });
  } catch {
    throw new Error(`${name}: is no picture that this browser reads.`);
  }
  const { width, height } = bitmap;
  if (width > MOST_SIDE || height > MOST_SIDE) {
    throw new Error(`${name}: is ${width} x ${height}; up to ${MOST_SIDE} x ${MOST_SIDE} are matched.`);
  }
  const canvas = new OffscreenCanvas(width, height);
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context.drawImage(bitmap, 0, 0);
  bitmap.close();
  return { name, width, height, pixels: context.getImageData(0, 0, width, height).data };
}

// A part of a picture, `width` columns from `first` on.
function columns(picture, first, width, name) {
  const { height } = picture;
  const pixels = new Uint8ClampedArray(4 * width * height);
  for (let y = 0; y < height; y += 1) {
    const from = 4 * (y * picture.width + first);
    pixels.set(picture.pixels.subarray(from, from + 4 * width), 4 * y * width);
  }
  return { name, width, height, pixels };
}

// Left and right of one picture with both side by side.
function halves(picture) {
  const { name, width } = picture;
  if (width % 2 !== 0) {
    throw new Error(`${name}: ${width} columns are no two halves; open two pictures, or one side by side.`);
  }
  return [columns(picture, 0, width / 2, name), columns(picture, width / 2, width / 2, name)];
}

// Throws a line where two pictures are no pair.
function checkSizes(left, right) {
  if (left.width === right.width && left.height === right.height) return;
  const size = ({ name, width, height }) => `${name} is ${width} x ${height}`;
  throw new Error(`${size(left)}, ${size(right)}: both must have one size.`);
}

const byName = (files) => [...files].sort((a, b) => a.name.localeCompare(b.name, "en", { numeric: true }));

// The frames of a sequence, each of two pictures whose names end with one number, or of one with both side by
// side. Throws a line where they are neither.
function framesOf(files) {
  const sorted = byName(files);
  const frames = new Map();
  for (const file of sorted) {
    const number = /(\d+)\D*$/.exec(file.name.replace(/\.[^.]*$/, ""))?.[1];
    frames.set(Number(number), [...(frames.get(Number(number)) ?? []), file]);
  }
  const found = [...frames.values()];
  const [count] = found.map(({ length }) => length);
  if (frames.has(NaN) || count > 2 || found.some(({ length }) => length !== count)) {
    throw new Error(`${files.length} files: of a sequence each number stands in the names of two pictures, `
      + "left and right, or in that of one with both side by side.");
  }
  return found;
}

// A pair of one picture or of two, which are left and right in the order of their names.
async function openPair(files) {
  const sorted = byName(files);
  const pictures = await Promise.all(sorted.map((file) => decode(file, file.name)));
  const pair = pictures.length === 2 ? pictures : halves(pictures[0]);
  const [left, right] = pair;
  checkSizes(left, right);
  return { left, right, isOne: pictures.length === 1 };
}

// Grey values by ITU-R BT.601 in the whole numbers of the core's `GreyLines`.
function toGrey({ pixels }, out) {
  for (let i = 0, from = 0; i < out.length; i += 1, from += 4) {
    out[i] = (4899 * pixels[from] + 9617 * pixels[from + 1] + 1868 * pixels[from + 2] + 8192) >> 14;
  }
}

// The numbers of a picture of them, whose first two channels are one number, the high byte first, and whose
// third is another.
const numbersOf = ({ pixels }) => Uint16Array.from({ length: pixels.length / 4 },
  (_, i) => 256 * pixels[4 * i] + pixels[4 * i + 1]);
const bytesOf = ({ pixels }) => Uint8Array.from({ length: pixels.length / 4 }, (_, i) => pixels[4 * i + 2]);

// A picture of the page's data, which is a data URL.
async function decodeUrl({ name, url }) {
  const bytes = Uint8Array.from(atob(url.slice(url.indexOf(",") + 1)), (letter) => letter.charCodeAt(0));
  return decode(new Blob([bytes], { type: "image/png" }), name);
}
