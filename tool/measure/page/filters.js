// The controls of the chart: the measure of error, and the points that are shown.

function showFilters() {
    const available = (metric) => points.some((point) => errorOf(point, metric));
    fillSelect(byId("metric"), METRICS.map((metric) => [metric.key, metric.name, !available(metric)]), state.metric,
               (metric) => change({metric}));
    const kinds = Object.keys(KINDS).filter((kind) => kind !== "default" && points.some((point) => point.kind === kind));
    fillSelect(byId("kind-filter"), [["", "every point"], ...kinds.map((kind) => [kind, `${KINDS[kind].name}, and the default`])], "",
               (kind) => change({kind}));
    byId("filters").replaceChildren(...settings.filter((setting) => valuesMeasured(setting).length > 1).map(filterOf));
    byId("clear-filter").addEventListener("click", () => {
        for (const select of document.querySelectorAll("#filters select, #kind-filter")) {
            select.value = "";
        }
        change({filter: {}, kind: ""});
    });
}

function valuesMeasured(setting) {
    return [...new Set(points.map((point) => valueAt(point, setting)))];
}

function filterOf(setting) {
    const select = html("select", {"data-setting": setting.name});
    fillSelect(select, [["", "any"], ...valuesMeasured(setting).map((value) => [value, value === String(setting.default) ? `${value} (default)` : value])], "",
               (value) => change({filter: {...state.filter, [setting.name]: value}}));
    return html("label", {title: setting.what}, setting.name, select);
}
