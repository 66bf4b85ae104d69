// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT

/// Which scene, condition or method is shown: what belongs to another one is hidden.
import { report } from "./data.js";
import { button, choice, el } from "./dom.js";

const chosen = {};
const listeners = [];

export const onFilter = (listener) => listeners.push(listener);

/// Whether a group is shown: no key of it says otherwise.
export const isShown = (group) =>
  Object.entries(chosen).every(([key, value]) => group?.[key] == null || group[key] === value);

export const isPartOf = (part, whole) =>
  Object.entries(part).every(([key, value]) => whole[key] === value);

export const nameOf = (group) =>
  report.keys.filter((key) => group[key] != null).map((key) => group[key]).join(" / ");

const selects = {};

export function show(group) {
  for (const [key, { select }] of Object.entries(selects)) {
    const value = group[key] ?? "";
    select.value = value;
    if (value === "") delete chosen[key];
    else chosen[key] = value;
  }
  apply();
}

function apply() {
  for (const element of document.querySelectorAll("[data-group]")) {
    if (element.tagName === "TH") continue;
    element.hidden = !isShown(JSON.parse(element.dataset.group));
  }
  for (const row of document.querySelectorAll("table.grid tbody tr")) {
    const group = row.firstElementChild.dataset.group;
    row.hidden = group != null && !isShown(JSON.parse(group));
  }
  for (const listener of listeners) listener();
}

function valuesOf(key) {
  const values = new Set(report.records.map((record) => record.group?.[key]));
  values.delete(undefined);
  return [...values];
}

/// Selects for scene, condition and method where there are several, in the page's bar.
export function mountFilter(bar) {
  const box = el("div", { class: "filter", role: "group", "aria-label": "Show only" });
  for (const key of ["scene", "condition", "method"]) {
    const values = valuesOf(key);
    if (values.length < 2) continue;
    const pairs = [["", `every ${key}`], ...values.map((value) => [value, value])];
    selects[key] = choice(key, pairs, (value) => {
      if (value === "") delete chosen[key];
      else chosen[key] = value;
      apply();
    });
    box.append(selects[key].element);
  }
  if (Object.keys(selects).length === 0) return;
  box.append(button("All", () => show({}), { class: "quiet" }));
  bar.append(box);
  for (const head of document.querySelectorAll("th[data-group]")) linkHead(head);
}

/// A heading of a table shows its method or scene alone.
function linkHead(head) {
  const group = JSON.parse(head.dataset.group);
  if (!Object.keys(group).some((key) => key in selects)) return;
  const text = head.firstChild?.nodeType === Node.TEXT_NODE ? head.firstChild.textContent : "";
  if (text === "") return;
  const isSame = () => Object.entries(group).every(([key, value]) => !(key in selects) || chosen[key] === value);
  head.firstChild.replaceWith(button(text, () => show(isSame() ? {} : group),
    { class: "link", title: `Only ${nameOf(group)}` }));
}
