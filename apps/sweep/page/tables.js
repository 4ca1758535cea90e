"use strict";
// Tables that sort by a click on a column's head, and buttons in them.

function element(name, properties = {}, ...children) {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...children);
  return made;
}

function say(text) {
  at("said").textContent = text;
}

/// Whether it is in the clipboard.
async function copyText(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    // Where the page may not use the clipboard of its own accord.
    const area = element("textarea", {value: text, className: "unseen"});
    const focused = document.activeElement;
    document.body.append(area);
    area.select();
    const copied = document.execCommand("copy");
    area.remove();
    focused?.focus({preventScroll: true});
    return copied;
  }
}

/// Copies, and shows what it copied: a phone has no other way to see it, and some have no clipboard for such pages.
function copyButton(command, {show = true} = {}) {
  if (!command) return kNone;
  const button = element("button", {type: "button", className: "small", textContent: "copy", title: command});
  button.setAttribute("aria-label", "Copy the command");
  button.addEventListener("click", async () => {
    const copied = await copyText(command);
    const text = copied ? "The command is in the clipboard" : "The clipboard is closed to this page: select the command";
    if (copied) {
      button.textContent = "copied";
      setTimeout(() => { button.textContent = "copy"; }, 1500);
    }
    say(text);
    if (!show) return;
    at("copied-note").textContent = `${text}.`;
    at("copied-command").textContent = command;
    at("copied").hidden = false;
  });
  return button;
}

function listenToCopied() {
  const close = () => { at("copied").hidden = true; };
  at("copied-close").addEventListener("click", close);
  document.addEventListener("keydown", event => { if (event.key === "Escape") close(); });
}

/// Nothing last, whichever the direction.
function compareValues(a, b, direction) {
  const none = x => x === null || x === undefined || Number.isNaN(x);
  if (none(a) || none(b)) return none(a) - none(b);
  return direction * (typeof a === "string" ? a.localeCompare(b, "en", {numeric: true}) : a - b);
}

/// columns: {label, unit, number, value: row => number|string|null, show: (value, row) => text or node, fixed: does not
/// sort}. Columns of numbers without any are left out. The order that was chosen outlives the rows.
function makeTable(id, columns, rows) {
  const host = at(id);
  const shown = columns.filter(c => !c.number || rows.some(row => isNumber(c.value(row))));
  const order = host.order ?? {};
  const sorted = [...rows];
  const keyOf = column => `${column.label} ${column.unit ?? ""}`;
  const by = shown.find(c => keyOf(c) === order.key);
  if (by) sorted.sort((a, b) => compareValues(by.value(a), by.value(b), order.direction));

  const head = shown.map(column => {
    const th = element("th", {scope: "col", className: column.number ? "number" : ""});
    const unit = column.unit ? [element("small", {textContent: column.unit})] : [];
    if (column.fixed) {
      th.append(element("span", {textContent: column.label}, ...unit));
      return th;
    }
    const button = element("button", {type: "button", textContent: column.label}, ...unit);
    if (column === by) th.setAttribute("aria-sort", order.direction > 0 ? "ascending" : "descending");
    button.dataset.key = keyOf(column);
    button.addEventListener("click", () => {
      host.order = {key: keyOf(column), direction: column === by ? -order.direction : 1};
      makeTable(id, columns, rows);
      host.querySelector(`button[data-key="${CSS.escape(keyOf(column))}"]`)?.focus();
    });
    th.append(button);
    return th;
  });
  const body = sorted.map(row => element("tr", {}, ...shown.map(column => {
    const value = column.value(row);
    const text = column.show ? column.show(value, row) : column.number ? formatNumber(value) : value || kNone;
    return element("td", {className: column.number ? "number" : column.className ?? ""}, text);
  })));
  host.replaceChildren(element("table", {}, element("thead", {}, element("tr", {}, ...head)), element("tbody", {}, ...body)));
}

/// "1.23 ± 0.04"
function spread(values, format = formatNumber) {
  const middle = mean(values);
  const around = deviation(values);
  if (middle === null || !around) return format(middle);
  return element("span", {}, format(middle), element("span", {className: "pm", textContent: ` ± ${formatNumber(around, 2)}`}));
}
