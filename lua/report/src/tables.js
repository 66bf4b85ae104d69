// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT

/// Tables that sort, and numbers that explain themselves.
import { report } from "./data.js";
import { button, el, short } from "./dom.js";
import { nameOf, show } from "./filter.js";

/// Rows by the value of a column; dashes stay below.
function sortBy(body, column, isDescending) {
  const rows = [...body.rows];
  const key = (row) => {
    const cell = row.cells[column];
    if (column === 0) return cell.textContent;
    return cell.dataset.value === undefined ? null : Number(cell.dataset.value);
  };
  rows.sort((a, b) => {
    const x = key(a), y = key(b);
    if (x === null || y === null) return (x === null) - (y === null);
    const order = typeof x === "number" ? x - y : x.localeCompare(y);
    return isDescending ? -order : order;
  });
  body.append(...rows);
}

/// A sorting button in each heading of the last row.
function mountSorting(table) {
  const body = table.tBodies[0];
  const row = table.tHead?.rows[table.tHead.rows.length - 1];
  if (!row || !body || body.rows.length < 2) return;
  const buttons = [...row.cells].map((head, column) => {
    const name = head.textContent || "name";
    const sort = button("↕", () => {
      const isDescending = head.getAttribute("aria-sort") === "ascending";
      for (const other of row.cells) other.removeAttribute("aria-sort");
      for (const other of buttons) other.textContent = "↕";
      head.setAttribute("aria-sort", isDescending ? "descending" : "ascending");
      sort.textContent = isDescending ? "↓" : "↑";
      sortBy(body, column, isDescending);
    }, { class: "quiet sort", "aria-label": `sort by ${name}` });
    return sort;
  });
  [...row.cells].forEach((head, column) => head.append(buttons[column]));
}

function line(term, text) {
  return text == null || text === "" ? [] : [el("dt", {}, term), el("dd", {}, text)];
}

const optionText = (options) =>
  Object.entries(options ?? {}).map(([key, value]) => `${key} ${JSON.stringify(value)}`).join(", ");

/// What a number is: definition, convention, how many things are behind it, what covers it.
function explanation(record) {
  const coverage = report.records.find((other) => other.name === "depth.coverage"
    && nameOf(other.group ?? {}) === nameOf(record.group ?? {}));
  const hasCoverage = record.name.startsWith("depth.") && coverage && coverage !== record;
  const value = record.value === null ? "–" : short(record.value) + (record.unit ? ` ${record.unit}` : "");
  return [
    el("p", {}, el("strong", {}, `${record.name} ${value}`)),
    el("p", {}, nameOf(record.group ?? {})),
    el("p", {}, report.definitions[record.name] ?? ""),
    el("dl", {}, ...line("better", record.better), ...line("convention", record.convention),
      ...line("n", record.n), ...line("coverage", hasCoverage ? short(coverage.value) : null),
      ...line("depends on", optionText(record.options)), ...line("note", record.note)),
  ];
}

function mountExplanations() {
  const box = el("div", { id: "explanation", role: "tooltip", hidden: true });
  document.body.append(box);
  let pinned = null;
  const hide = () => {
    if (!pinned) box.hidden = true;
  };
  const open = (cell) => {
    const record = report.records[Number(cell.dataset.record)];
    box.replaceChildren(...explanation(record));
    if (pinned && record.group) {
      box.append(button("Show this result alone", () => { show(record.group); }), " ",
        button("Close", () => { pinned = null; hide(); cell.focus(); }, { class: "quiet" }));
    }
    box.hidden = false;
    const place = cell.getBoundingClientRect();
    const left = Math.min(place.left, innerWidth - box.offsetWidth - 8);
    const below = place.bottom + 6;
    const fits = below + box.offsetHeight < innerHeight || place.top < box.offsetHeight + 12;
    box.style.left = `${Math.max(8, left) + scrollX}px`;
    box.style.top = `${(fits ? below : place.top - box.offsetHeight - 6) + scrollY}px`;
  };
  for (const cell of document.querySelectorAll("td[data-record]")) {
    cell.removeAttribute("title");
    cell.setAttribute("aria-describedby", "explanation");
    const unpinned = () => { if (!pinned) open(cell); };
    cell.addEventListener("mouseenter", unpinned);
    cell.addEventListener("focus", unpinned);
    cell.addEventListener("mouseleave", hide);
    cell.addEventListener("blur", hide);
    const pin = () => { pinned = cell; open(cell); };
    cell.addEventListener("click", pin);
    cell.addEventListener("keydown", (event) => {
      if (event.key === "Enter") pin();
    });
  }
  const release = () => { pinned = null; hide(); };
  document.addEventListener("keydown", (event) => { if (event.key === "Escape") release(); });
  document.addEventListener("pointerdown", (event) => {
    if (!box.contains(event.target) && !event.target.closest?.("td[data-record]")) release();
  });
}

export function mountTables() {
  for (const table of document.querySelectorAll("table.grid")) mountSorting(table);
  mountExplanations();
}
