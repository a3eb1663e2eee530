// The table of the settings, one at a time.

let sorting = {column: "setting", ascending: true};

function settingColumns() {
    const metric = metricOf(state.metric);
    return [
        {key: "setting", name: "Setting", of: ({order}) => order},
        {key: "value", name: "Value", of: ({value}) => (Number.isNaN(Number(value)) ? value : Number(value))},
        {key: "stage", name: "Chosen at", of: ({setting}) => setting.stage},
        {key: "ratio", name: "Time over default", of: ({point}) => point?.ratio?.median ?? null},
        {key: "time", name: "Time, ms", of: ({point}) => (point && isMeasured(point) ? timeOf(point) : null)},
        {key: "error", name: signedName(metric) + (metric.unit ? `, ${metric.unit}` : ""),
         of: ({point}) => (point && errorOf(point, metric) ? inexactness(point, metric) : null)},
    ];
}

function settingRows() {
    let order = 0;
    return settings.flatMap((setting) => [
        ...setting.values.map((value) => {
            const isDefault = String(value) === String(setting.default);
            return {setting, value: String(value), isDefault, point: isDefault ? defaultPoint : singleOf(setting, value), order: order++};
        }),
        ...skippedOf(setting).map(([reason, values]) => ({setting, value: values.join(", "), reason, point: null, order: order++})),
    ]);
}

// Returns the values that were not tried, grouped by reason: [reason, values].
function skippedOf(setting) {
    const byReason = new Map();
    for (const {value, reason} of setting.skipped ?? []) {
        byReason.set(reason, [...(byReason.get(reason) ?? []), value]);
    }
    return [...byReason];
}

// Skipped rows have no number and stay last, whichever way the rest is sorted.
function compareRows(a, b, column) {
    const [x, y] = [column.of(a), column.of(b)];
    if (x === null || y === null) {
        return (x === null) - (y === null) || a.order - b.order;
    }
    const compared = typeof x === "number" && typeof y === "number" ? x - y : String(x).localeCompare(String(y));
    return (sorting.ascending ? compared : -compared) || a.order - b.order;
}

function showSettingsTable() {
    const columns = settingColumns();
    const column = columns.find(({key}) => key === sorting.column);
    const rows = settingRows().sort((a, b) => compareRows(a, b, column));
    byId("settings-table").replaceChildren(
        html("thead", {}, html("tr", {}, columns.map(headerOf))),
        html("tbody", {}, rows.map(settingsTableRow)));
    byId("settings-note").textContent = `Each value beside the default, all else as it is; in brackets ${confidenceText()} confidence intervals. ` +
        "A tie: the measurement does not tell the value from the default. Settings chosen at build are part of a package: glint compile takes them, " +
        "and another value needs another package; those chosen at render can change from run to run.";
}

function headerOf(column) {
    const sorted = sorting.column === column.key;
    return html("th", {scope: "col", "aria-sort": sorted ? (sorting.ascending ? "ascending" : "descending") : "none"},
        html("button", {type: "button", "data-sort": column.key, onclick: () => {
            sorting = {column: column.key, ascending: !sorted || !sorting.ascending};
            showSettingsTable();
            document.querySelector(`[data-sort="${column.key}"]`).focus();
        }}, column.name, html("span", {"aria-hidden": "true"}, sorted ? (sorting.ascending ? " ▲" : " ▼") : "")));
}

function settingsTableRow({setting, value, isDefault, reason, point}) {
    const stage = setting.stage === "compile" ? "build" : setting.stage;
    const start = [html("th", {scope: "row", title: setting.what}, setting.name), html("td", {}, value, isDefault ? html("span", {class: "was"}, " default") : ""),
                   html("td", {}, stage)];
    if (!point) {
        return html("tr", {class: "skipped"}, start, html("td", {colspan: 3}, reason ? `not measured: ${reason}` : "not measured by itself"));
    }
    return html("tr", {class: isDefault ? "default" : "", "data-id": point.id}, start,
        isDefault ? html("td", {}, "1") : html("td", {}, ratioText(point.ratio), tieMark(point.timeTie)),
        html("td", {}, `${number(point.time?.median)} ${range(point.time)}`),
        html("td", {}, errorCell(point, isDefault)));
}

function errorCell(point, isDefault) {
    const metric = metricOf(state.metric);
    const text = errorText(point, metric);
    if (isDefault) {
        return text;
    }
    if (point.sameImage) {
        return [text, html("span", {class: "tie"}, "same picture")];
    }
    // The report judges ties by its own measure.
    return [text, metric.key === ownMetric().key ? tieMark(point.errorTie) : ""];
}

function tieMark(isTie) {
    return isTie ? html("span", {class: "tie"}, "tie") : "";
}
