// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT

/// The report's document and its packed data.

export const report = JSON.parse(document.getElementById("report").textContent);

/// The bytes of a data element: base64 of a zlib stream.
async function bytes(id) {
  const text = atob(document.getElementById(`data-${id}`).textContent);
  const packed = Uint8Array.from(text, (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

const isLittleEndian = new Uint8Array(new Uint16Array([1]).buffer)[0] === 1;

/// Unsigned numbers of 8, 16 or 32 bits.
export async function numbers(id, Type) {
  const buffer = await bytes(id);
  if (isLittleEndian || Type.BYTES_PER_ELEMENT === 1) return new Type(buffer);
  const view = new DataView(buffer);
  const n = Type.BYTES_PER_ELEMENT;
  const read = n === 2 ? (i) => view.getUint16(2 * i, true) : (i) => view.getUint32(4 * i, true);
  return Type.from({ length: buffer.byteLength / n }, (_, i) => read(i));
}

/// The step that stands for "no value", and the last one of a range.
export const none16 = 65535;
export const last16 = 65534;

/// The value of a step.
export const valueOf = (step, { low, high }) =>
  step === none16 ? NaN : low + ((high - low) * step) / last16;
