// The chart of error against time, and its controls: the measure of error, and the points that are shown.

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

let chartPoints = [];  // {point, x, y, node} of each drawn point, the fastest first

function drawChart() {
    const box = byId("chart-box");
    const metric = metricOf(state.metric);
    const width = Math.max(300, Math.floor(box.clientWidth));
    const height = width < 600 ? 380 : 520;
    const usable = points.filter((point) => isMeasured(point) && errorOf(point, metric));
    const shown = usable.filter(isShown);
    const axes = makeAxes(width, height, metric, shown.length > 0 ? shown : usable);
    const front = frontFor(metric);
    const onFront = new Set(front);
    const corners = frontCorners(axes, metric, front);

    chartPoints = shown.map((point) => ({point, x: axes.x(point.time.median), y: axes.y(errorOf(point, metric).value)}))
        .sort((a, b) => a.point.time.median - b.point.time.median);
    const picture = svg("svg", {
        id: "error-time", width, height, viewBox: `0 0 ${width} ${height}`, role: "group",
        "aria-label": `${metric.name} against time of ${plural(shown.length, "point")}; arrow keys go from point to point, Enter selects`,
        onpointermove: (event) => change({pointed: nearest(event)}), onpointerleave: () => change({pointed: focusedId()}),
        onclick: (event) => { const id = nearest(event); if (id !== null) { change({selected: id}); } },
        onkeydown: moveByKeys,
    }, drawAxes(axes, metric), drawNoise(axes), clipped(axes, drawFront(corners)));
    picture.append(clipped(axes, chartPoints.map(({point, x, y}) => whiskers(axes, metric, point, x, y))));
    // The important points are drawn last, on top.
    const rank = ({point}) => (point.kind === "default" ? 2 : 0) + (onFront.has(point.id) ? 1 : 0);
    picture.append(...[...chartPoints].sort((a, b) => rank(a) - rank(b)).map((drawn) => drawPoint(drawn, metric, onFront)));
    box.querySelector("svg")?.remove();
    box.prepend(picture);
    drawLabels(picture, axes, front, corners);
    markPoints();
    showFrontList(metric, front);
    byId("shown").textContent = shown.length === usable.length ? `${plural(usable.length, "point")}`
        : `${shown.length} of ${plural(usable.length, "point")}`;
    byId("metric-note").textContent = `${metric.what} Down and left is better. Whiskers are ${confidenceText()} confidence intervals of the medians.` +
        (axes.floor === null && axes.hasErrors && noiseOf(metric) !== null ? ` The noise of the reference itself, ${number(noiseOf(metric))}, is far below the chart.` : "");
}

function confidenceText() {
    return `${number((report.method?.confidence ?? 0.95) * 100, 2)} %`;
}

function drawNoise(axes) {
    if (axes.floor === null) {
        return [];
    }
    const y = axes.y(axes.floor);
    return [svg("path", {class: "noise", d: `M${MARGIN.left},${y}H${axes.width - MARGIN.right}`}),
            svg("text", {class: "noise-name", x: axes.width - MARGIN.right - 4, y: y - 5, "text-anchor": "end"},
                "noise of the reference itself")];
}

// The staircase of the front: for each time, the least error that can be reached within it.
function frontCorners(axes, metric, front) {
    const ends = front.map((id) => pointById.get(id)).filter((point) => isMeasured(point) && errorOf(point, metric))
        .map((point) => ({x: axes.x(point.time.median), y: axes.y(errorOf(point, metric).value)}));
    return ends.flatMap((end, i) => (i === 0 ? [end] : [{x: end.x, y: ends[i - 1].y}, end]));
}

function drawFront(corners) {
    return corners.length > 1 ? [svg("path", {class: "front-line", d: `M${corners.map(({x, y}) => `${x},${y}`).join("L")}`})] : [];
}

function whiskers(axes, metric, point, x, y) {
    const error = errorOf(point, metric);
    const {low, high} = point.time;
    const across = isNumber(low) && isNumber(high) ? `M${axes.x(low)},${y}H${axes.x(high)}` : "";
    return svg("path", {class: "whisker", d: `${across}M${x},${axes.y(error.low)}V${axes.y(error.high)}`});
}

function drawPoint(drawn, metric, onFront) {
    const {point, x, y} = drawn;
    const front = onFront.has(point.id);
    drawn.node = svg("g", {
        class: front ? "point front" : "point", "data-id": point.id, tabindex: -1, role: "button", transform: `translate(${x} ${y})`,
        "aria-label": `${point.name}: ${milliseconds(point.time.median)}, ${signedName(metric)} ${errorText(point, metric)}${front ? ", on the front" : ""}`,
        onfocus: () => change({pointed: point.id}), onblur: () => change({pointed: null}),
    }, front ? svg("circle", {class: "ring", r: 10}) : null, marker(kindOf(point)));
    return drawn.node;
}

// Labels the front and the default with names. In a narrow chart, the front gets the numbers of the list
// below.
function drawLabels(picture, axes, front, corners) {
    const wide = axes.width >= 600;
    const labels = svg("g", {class: "labels", "aria-hidden": "true"});
    picture.append(labels);
    const named = [...new Set([defaultPoint?.id, ...front])];
    const anchors = named.flatMap((id) => {
        const drawn = chartPoints.find((other) => other.point.id === id);
        if (!drawn) {
            return [];
        }
        const isNumbered = !wide && drawn.point !== defaultPoint;
        const text = svg("text", {class: "label"}, isNumbered ? String(front.indexOf(id) + 1) : shorten(drawn.point.name, 34));
        labels.append(text);
        return [{x: drawn.x, y: drawn.y, width: text.getComputedTextLength() + 4, text}];
    });
    const obstacles = [...chartPoints.map(({x, y}) => boxAround(x, y, 16, 16)), ...boxesAlong(corners)];
    const within = {left: MARGIN.left + 2, right: axes.width - MARGIN.right, top: MARGIN.top, bottom: axes.height - MARGIN.bottom};
    placeLabels(anchors, obstacles, within).forEach((box, index) => {
        const {text} = anchors[index];
        if (!box) {
            text.remove();
            return;
        }
        text.setAttribute("x", box.left + 2);
        text.setAttribute("y", box.bottom - 4);
        const line = leader(anchors[index], box);
        if (line) {
            labels.prepend(line);
        }
    });
}

function focusedId() {
    const id = document.activeElement?.closest?.("g.point")?.dataset.id;
    return id === undefined ? null : Number(id);
}

// Returns the point nearest to the pointer, within 24 pixels.
function nearest(event) {
    const bounds = byId("error-time").getBoundingClientRect();
    const x = event.clientX - bounds.left;
    const y = event.clientY - bounds.top;
    let best = null;
    let least = 24;
    for (const drawn of chartPoints) {
        const distance = Math.hypot(drawn.x - x, drawn.y - y);
        if (distance < least) {
            least = distance;
            best = drawn.point.id;
        }
    }
    return best;
}

// The chart is one stop of the tab key. Left and right move by time, up and down by error.
function moveByKeys(event) {
    const id = focusedId();
    if (event.key === "Enter" || event.key === " ") {
        event.preventDefault();
        change({selected: id});
        return;
    }
    const byError = event.key === "ArrowUp" || event.key === "ArrowDown";
    const order = byError ? [...chartPoints].sort((a, b) => b.y - a.y) : chartPoints;
    const at = order.findIndex(({point}) => point.id === id);
    const to = {ArrowRight: at + 1, ArrowUp: at + 1, ArrowLeft: at - 1, ArrowDown: at - 1, Home: 0, End: order.length - 1}[event.key];
    if (to !== undefined) {
        event.preventDefault();
        order[Math.min(Math.max(to, 0), order.length - 1)].node.focus();
    }
}

// Marks the points that are selected and pointed at, without drawing the chart again.
function markPoints() {
    const stop = chartPoints.find(({point}) => point.id === state.selected) ?? chartPoints[0];
    for (const drawn of chartPoints) {
        const {node, point} = drawn;
        node.classList.toggle("selected", point.id === state.selected);
        node.classList.toggle("pointed", point.id === state.pointed);
        node.setAttribute("aria-pressed", point.id === state.selected);
        node.setAttribute("tabindex", drawn === stop ? 0 : -1);
    }
    showTip(chartPoints.find(({point}) => point.id === state.pointed));
}

function showTip(drawn) {
    const tip = byId("tip");
    tip.hidden = !drawn;
    if (!drawn) {
        return;
    }
    const metric = metricOf(state.metric);
    tip.replaceChildren(html("strong", {}, drawn.point.name), html("br"), `${milliseconds(drawn.point.time.median)}, ${signedName(metric)} ${errorText(drawn.point, metric)}`);
    const room = byId("chart-box").clientWidth - tip.offsetWidth - 4;
    tip.style.left = `${Math.max(4, Math.min(drawn.x + 14, room))}px`;
    tip.style.top = `${drawn.y > 90 ? drawn.y - tip.offsetHeight - 14 : drawn.y + 16}px`;
}

function showFrontList(metric, front) {
    byId("front-note").textContent = metric.key === ownMetric().key
        ? "Of these, none is beaten in both time and error."
        : `By the medians of ${metric.name}; the report's own front is that of ${ownMetric().name}.`;
    byId("front-list").replaceChildren(...front.map((id) => {
        const point = pointById.get(id);
        return html("li", {}, html("button", {type: "button", class: "link", onclick: () => change({selected: id})}, point.name),
                    ` ${milliseconds(point.time?.median)}, ${signedName(metric)} ${errorText(point, metric)}`);
    }));
}
