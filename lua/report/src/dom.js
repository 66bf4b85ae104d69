// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT

/// Elements. Texts go in as texts, never as markup: a label cannot break or inject anything.

/// An element with attributes (functions are listeners) and children (elements or texts).
export function el(name, attributes = {}, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(key, value);
    else if (value === true) element.setAttribute(key, "");
    else if (value !== false && value != null) element.setAttribute(key, String(value));
  }
  element.append(...children.filter((child) => child != null));
  return element;
}

/// A labelled select over [value, text] pairs.
export function choice(label, pairs, onChange) {
  const select = el("select", { change: () => onChange(select.value) },
    ...pairs.map(([value, text]) => el("option", { value }, text)));
  return { element: el("label", { class: "choice" }, el("span", {}, label), select), select };
}

export const button = (text, onClick, attributes = {}) =>
  el("button", { type: "button", click: onClick, ...attributes }, text);

/// Five significant digits, as the tables have them.
export function short(x) {
  if (x == null || Number.isNaN(x)) return "–";
  return Number.isInteger(x) ? String(x) : String(Number(x.toPrecision(5)));
}

/// Three significant digits, for the ends of scales.
export const rough = (x) => String(Number(x.toPrecision(3)));

/// A colour that the style sheet names.
export const themed = (name) =>
  getComputedStyle(document.documentElement).getPropertyValue(name).trim();
