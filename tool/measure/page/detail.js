// Shows every setting and number of one point: the one under the pointer, or else the selected one.

function showDetail() {
    const point = pointById.get(state.pointed) ?? selectedPoint();
    const panel = byId("detail");
    if (!point) {
        panel.replaceChildren(html("p", {}, "No point is selected."));
        return;
    }
    const notes = [point.id === state.selected ? "selected" : null, point.id === report.advice?.point ? "advised" : null,
                   frontFor(metricOf(state.metric)).includes(point.id) ? "on the Pareto front" : null,
                   point.sameImage && point !== defaultPoint ? "the same picture as the default, bit by bit" : null];
    panel.replaceChildren(
        html("h3", {}, point.name),
        html("p", {class: "note"}, [kindOf(point).name, ...notes.filter((note) => note)].join(", ")),
        table("numbers", numberRows(point)),
        html("h4", {}, "Settings"),
        table("chosen", settings.map((setting) => settingRow(point, setting))),
        point.command ? commandOf(point) : "");
}

function commandOf(point) {
    return html("p", {class: "command"}, html("code", {}, point.command),
                copyButton(html("button", {type: "button"}, "Copy"), point.command));
}

function table(name, rows) {
    return html("table", {class: name}, html("tbody", {}, rows));
}

function row(term, ...cells) {
    return html("tr", {}, html("th", {scope: "row"}, term), cells.map((cell) => html("td", {}, cell)));
}

function numberRows(point) {
    const isDefault = point === defaultPoint;
    const tie = (isTie) => (isTie && !isDefault ? " tie" : "");
    const rows = [row("Time", timeText(point.time))];
    if (point.ratio && !isDefault) {
        rows.push(row("Over the default", ratioText(point.ratio) + tie(point.timeTie)));
    }
    for (const metric of METRICS) {
        if (errorOf(point, metric)) {
            const own = metric.key === ownMetric().key;
            rows.push(row(signedName(metric), errorText(point, metric) + tie(own && point.errorTie)));
        }
    }
    const facts = [["Rays", count(point.rays)], ["Cases", count(point.cases)], ["Pipelines", count(point.pipelines)],
                   ["Buffers and images", bytesText(point.bytes)]];
    return [...rows, ...facts.filter(([, text]) => text !== NONE).map(([term, text]) => row(term, text))];
}

function settingRow(point, setting) {
    const value = valueAt(point, setting);
    const changed = value !== String(setting.default);
    return html("tr", {class: changed ? "changed" : ""}, html("th", {scope: "row", title: setting.what}, setting.name),
                html("td", {}, value, changed ? html("span", {class: "was"}, ` (default ${setting.default})`) : ""));
}
