// Creates elements of HTML and SVG. Texts become text nodes, so no name of a scene is ever read as markup.

const SVG = "http://www.w3.org/2000/svg";

function byId(id) {
    return document.getElementById(id);
}

function fill(node, attributes, children) {
    for (const [name, value] of Object.entries(attributes)) {
        if (name.startsWith("on")) {
            node.addEventListener(name.slice(2), value);
        } else if (value !== null && value !== undefined && value !== false) {
            node.setAttribute(name, value === true ? "" : value);
        }
    }
    node.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined));
    return node;
}

function html(name, attributes = {}, ...children) {
    return fill(document.createElement(name), attributes, children);
}

function svg(name, attributes = {}, ...children) {
    return fill(document.createElementNS(SVG, name), attributes, children);
}

// Fills a table with columns by name and rows.
function fillTable(table, columns, rows) {
    table.replaceChildren(html("thead", {}, html("tr", {}, columns.map((name) => html("th", {scope: "col"}, name)))), html("tbody", {}, rows));
    return table;
}

// Hides a section for which the report has nothing, and its link.
function hideSection(id) {
    byId(id).hidden = true;
    byId("contents").querySelector(`a[href="#${id}"]`)?.remove();
}

// Fills a <select> with [value, text] and calls back with the chosen value.
function fillSelect(select, options, chosen, changed) {
    select.replaceChildren(...options.map(([value, text, disabled]) => html("option", {value, disabled}, text)));
    select.value = chosen;
    if (changed) {
        select.addEventListener("change", () => changed(select.value));
    }
}

function copyButton(button, text) {
    button.addEventListener("click", async () => {
        const copied = await copyText(text);
        button.textContent = copied ? "Copied" : "Press Ctrl+C";
        setTimeout(() => { button.textContent = "Copy"; }, 2000);
    });
    return button;
}

// In some browsers the clipboard's interface is missing if a page was opened as a file. Then the text is
// selected and copied by the old command.
async function copyText(text) {
    try {
        await navigator.clipboard.writeText(text);
        return true;
    } catch {
        const area = html("textarea", {class: "away"});
        area.value = text;
        document.body.append(area);
        area.select();
        const copied = document.execCommand("copy");
        area.remove();
        return copied;
    }
}
