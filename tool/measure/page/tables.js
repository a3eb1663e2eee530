// The tables: all points, the settings one at a time, how the default's error is divided among its approximations, and
// which strategy is fastest here.

function showPointsTable() {
    const metrics = METRICS.filter((metric) => points.some((point) => errorOf(point, metric)));
    const order = points.filter(isMeasured).filter(isShown).sort((a, b) => timeOf(a) - timeOf(b));
    const front = new Set(frontFor(metricOf(state.metric)));
    const columns = ["Point", "Time, ms", "Over the default", ...metrics.map((metric) => signedName(metric) + (metric.unit ? `, ${metric.unit}` : ""))];
    fillTable(byId("points-table"), columns, order.map((point) => html("tr", {"data-id": point.id},
        html("th", {scope: "row"}, point.name, front.has(point.id) ? html("span", {class: "tie"}, "front") : ""),
        html("td", {}, `${number(point.time.median)} ${range(point.time)}`),
        html("td", {}, point === defaultPoint ? "1" : [ratioText(point.ratio), tieMark(point.timeTie)]),
        metrics.map((metric) => html("td", {}, errorText(point, metric))))));
}

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

// A bar from the middle for settings that grow the error, and to the right for settings that reduce it.
function shareBar(share) {
    const size = Math.min(1, Math.abs(share)) * 100;
    return html("span", {class: "share-bar", "aria-hidden": "true"},
        html("span", {class: share < 0 ? "grows" : "goes", style: `width: ${size.toFixed(1)}%`}));
}

// `removed` is of the report's errorParts, or {bias, noise} alone.
function partRow(name, removed, kind = null) {
    const point = pointById.get(removed.point);
    const cell = (share) => html("td", {}, isNumber(share) ? [shareBar(share), percent(share)] : "");
    return html("tr", {class: kind},
        html("th", {scope: "row"}, point ? html("button", {type: "button", class: "link", onclick: () => change({selected: point.id})}, name) : name),
        cell(removed.bias), cell(removed.noise),
        html("td", {}, removed.removed ? `${percent(removed.removed.median)} [${percent(removed.removed.low)}, ${percent(removed.removed.high)}]` : ""),
        html("td", {}, point?.ratio ? ratioText(point.ratio) : "", point?.timeTie ? html("span", {class: "tie"}, "tie") : null),
        html("td", {}, point ? errorText(point, metricOf(state.metric)) : ""));
}

function showErrorParts() {
    const all = report.errorParts;
    if (!all || all.parts.length === 0) {
        hideSection("error-parts");
        return;
    }
    const rows = [
        ...all.parts.map((part) => partRow(`${part.setting} ${part.to} instead of ${part.from}`, part)),
        partRow("any number of samples", {noise: all.noise}),
        partRow("the rest", {bias: all.rest}),
        ...(all.exact ? [partRow("all these values together, same samples", all.exact, "sum")] : []),
    ];
    const columns = ["Exact value alone", "Bias that goes", "Noise that goes", "Both", "Time over default", signedName(metricOf(state.metric))];
    fillTable(byId("error-parts-table"), columns, rows);
    byId("error-parts-note").textContent =
        `Errors are measured against ${report.reference?.what ?? "the reference"}. Each row gives one setting the reference's value and leaves the others as they are. ` +
        `Shares are of the default's error, ${ownMetric().name}${ownMetric().key === "rmse" ? " squared" : ""}: bias is what no number of samples takes away, and noise is the rest of the error. ` +
        "Below 0 the error grows. The rest is bias that no single value takes away: above 0, several have to be exact together; below 0, the shares overlap.";
}

function showStrategies() {
    const rows = report.strategies?.rows ?? [];
    const box = byId("strategies-box");
    if (rows.length === 0) {
        box.replaceChildren(html("p", {}, "No strategies were compared."));
        return;
    }
    const fastest = report.strategies.fastest ?? [];
    const columns = [
        ["Strategy", (row) => [row.strategy, fastest.includes(row.strategy) ? html("span", {class: "tie"}, fastest.length > 1 ? "fastest, a tie" : "fastest") : ""]],
        ["Time, ms", (row) => `${number(row.time?.median)} ${range(row.time)}`],
        ["Over the default", (row) => ratioText(row.ratio)],
        ["Hits, ms", (row) => (row.hits ? `${number(row.hits.median)} ${range(row.hits)}` : NONE)],
        ["Hits over the default's", (row) => (row.hitRatio ? ratioText(row.hitRatio) : NONE)],
        ["Tracing, ms", (row) => number(row.traceMs)],
        ["Shading, ms", (row) => number(row.shadeMs)],
        ["Ordering, ms", (row) => number(row.orderMs)],
        ["Rays", (row) => count(row.rays)],
    ].filter(([, cell], index) => index < 2 || rows.some((row) => cell(row) !== NONE));
    box.replaceChildren(
        html("ul", {class: "why"}, (report.strategies.why ?? []).map((sentence) => html("li", {}, sentence))),
        html("div", {class: "scroll", tabindex: 0, role: "region", "aria-labelledby": "strategies-title"},
            fillTable(html("table", {id: "strategies-table"}), columns.map(([name]) => name),
                rows.map((row) => html("tr", {class: fastest.includes(row.strategy) ? "changed" : ""},
                    columns.map(([, cell], index) => (index === 0 ? html("th", {scope: "row"}, cell(row)) : html("td", {}, cell(row)))))))));
}
