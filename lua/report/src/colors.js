// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT

/// The colours of values, as aib's pictures have them: straight lines in OKLab, equal steps to the eye.

const toLinear = (c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
const fromLinear = (c) => (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055);

function toOklab(rgb) {
  const [r, g, b] = rgb.map((c) => toLinear(c / 255));
  const l = Math.cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const m = Math.cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const s = Math.cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return [0.2104542553 * l + 0.793617785 * m - 0.0040720468 * s,
    1.9779984951 * l - 2.428592205 * m + 0.4505937099 * s,
    0.0259040371 * l + 0.7827717662 * m - 0.808675766 * s];
}

function toRgb([lightness, a, b]) {
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s]
    .map((c) => Math.round(255 * Math.min(1, Math.max(0, fromLinear(c)))));
}

function ramp(from, to, n) {
  const a = toOklab(from), b = toOklab(to);
  return Array.from({ length: n }, (_, i) => toRgb(a.map((x, k) => x + ((b[k] - x) * i) / (n - 1))));
}

const grey = [238, 238, 238];
/// 256 colours from dark blue to light yellow.
export const sequential = ramp([0, 32, 96], [255, 233, 69], 256);
/// 256 colours from blue over light grey to red.
export const diverging = [...ramp([20, 70, 170], grey, 128), ...ramp(grey, [170, 30, 40], 128)];

/// A CSS gradient of a table of colours.
export const gradient = (table) => `linear-gradient(to right, ${
  table.filter((_, i) => i % 15 === 0).map((c) => `rgb(${c.join(" ")})`).join(", ")})`;
