// What the settings take of a microcontroller: the figures of `stereo plan`, which are in the page's data.

// Bytes of RAM that a pipeline takes at most: they grow with the width, the disparities in steps of 16, and
// the product of both, and rows of no whole words have some bytes between them.
function ramBytes(method, width, disparities) {
  const [product, perColumn, perDisparity, fixed, padding] = DATA.ram[METHODS[method]];
  const lanes = 16 * Math.ceil(disparities / 16);
  const columns = Math.max(width, lanes);
  return product * columns * lanes + perColumn * columns + perDisparity * lanes + fixed
    + (columns % 4 ? padding : 0);
}

// Instructions for a frame on a core.
function instructions(core, method, pixels, disparities) {
  const perPixel = DATA.work[core][METHODS[method]];
  return perPixel[disparities / 16 - 1] * pixels;
}

// Writes the table and the line about memory anew.
function showWork({ settings, planes }) {
  const [method, disparities] = [settings[at("method")], settings[at("disparities")]];
  const bytes = ramBytes(method, planes.width, disparities);
  const size = `${planes.width} x ${planes.height} with ${disparities} disparities`;
  byId("memory").textContent = `${METHODS[method]} at ${size}: ${bytes} bytes of RAM `
    + `(${(bytes / 1024).toFixed(1)} KB) at most, on any core.`;
  const rows = DATA.cores.map(([core, mhz]) => {
    const count = instructions(core, method, planes.width * planes.height, disparities);
    const row = make("tr");
    const rate = (mhz * 1e6) / count;
    const cells = [String(mhz), (count / 1e6).toFixed(1), rate.toFixed(rate < 10 ? 2 : 1)];
    row.append(make("th", { scope: "row" }, core), ...cells.map((cell) => make("td", {}, cell)));
    return row;
  });
  byId("work").replaceChildren(...rows);
}
