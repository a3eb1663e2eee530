// The heading, sentences that name the measured scene and the result, and the method in words.

function showHeading() {
    const scene = report.scene ?? {};
    const machine = report.machine ?? {};
    const name = scene.name || scene.file || "a scene";
    document.title = `${name}: what accuracy costs in time`;
    byId("title").textContent = name;
    byId("subtitle").textContent = `What accuracy costs in time, on ${machine.device ?? "an unknown device"}.`;
    const facts = [
        ["Scene", [scene.file, scene.triangles !== undefined && plural(scene.triangles, "triangle"),
                   scene.materials !== undefined && plural(scene.materials, "material"),
                   scene.instances !== undefined && plural(scene.instances, "instance"),
                   scene.lights !== undefined && plural(scene.lights, "light")]],
        ["Picture", [`${scene.width} × ${scene.height} pixels`, scene.camera && `camera ${scene.camera}`,
                     scene.environment ? `environment ${scene.environment}` : "no environment map"]],
        ["Device", [machine.device, machine.deviceType, (machine.tracers ?? []).join(" and ")]],
        ["Driver", [machine.driver]],
        ["Host", [machine.cpu, machine.cores && plural(machine.cores, "core"), machine.os]],
        ["Glint", [report.tool, report.commit && `commit ${report.commit}`]],
        ["Date", [report.date?.replace("T", " ").replace("Z", " UTC")]],
    ];
    byId("facts").replaceChildren(...facts.flatMap(([term, parts]) => {
        const text = parts.filter((part) => part).join(", ");
        return text ? [html("div", {}, html("dt", {}, term), html("dd", {}, text))] : [];
    }));
    byId("command").textContent = report.command ?? "";
    copyButton(byId("copy-command"), report.command ?? "");
    byId("summary").replaceChildren(...summarySentences().map((sentence) => html("li", {}, sentence)));
    byId("footer").textContent = `Made by glint bench ${report.tool ?? ""}. This file is complete: it opens without a network.`;
    byId("contents").replaceChildren(...[...document.querySelectorAll("main > section")].map((section) =>
        html("a", {href: `#${section.id}`}, section.querySelector("h2").textContent)));
}

function comparedToDefault(point) {
    if (point === defaultPoint || !point.ratio) {
        return "";
    }
    return point.timeTie ? ", a tie in time with the default"
        : `, ${number(point.ratio.median)} times the time of the default`;
}

function summarySentences() {
    const metric = ownMetric();
    const measured = points.filter((point) => isMeasured(point) && errorOf(point, metric));
    if (measured.length === 0) {
        return ["No point has both a time and an error."];
    }
    const least = (value) => measured.reduce((best, point) => (value(point) < value(best) ? point : best));
    const fastest = least(timeOf);
    const exact = least((point) => inexactness(point, metric));
    const describe = (point) => `${milliseconds(point.time.median)}, ${metric.name} ${errorText(point, metric)}`;
    const sentences = [
        `Fastest: ${fastest.name} (${describe(fastest)})${comparedToDefault(fastest)}.`,
        `Most exact: ${exact.name} (${describe(exact)})${comparedToDefault(exact)}.`,
    ];
    if (defaultPoint && measured.includes(defaultPoint)) {
        const onFront = frontFor(metric).includes(defaultPoint.id);
        sentences.push(`The default takes ${describe(defaultPoint)}; it is ${onFront ? "" : "not "}on the Pareto front.`);
    }
    return [...sentences, ...adviceSentences(), ...strategySentences()];
}

function adviceSentences() {
    const advice = report.advice;
    if (!advice) {
        return [];
    }
    const limits = [];
    if (isNumber(advice.budgetMs)) {
        limits.push(`a budget of ${milliseconds(advice.budgetMs)}`);
    }
    if (isNumber(advice.maxError)) {
        limits.push(`a ${metricOf(advice.metric).name} of at most ${number(advice.maxError)}`);
    }
    const goal = limits.length > 0 ? `For ${limits.join(" and ")}` : "Advice";
    const point = pointById.get(advice.point);
    const file = point && advice.file ? ` The settings are in ${advice.file}.` : "";
    return [`${goal}: ${advice.why ?? (point ? point.name : "nothing fits")}${file}`];
}

function strategySentences() {
    const strategies = report.strategies;
    const fastest = strategies?.fastest ?? [];
    if (fastest.length === 0) {
        return [];
    }
    const verdict = fastest.length === 1 ? `The fastest strategy is ${fastest[0]}`
        : `The fastest strategies, a tie, are ${sentenceList(fastest)}`;
    return [`${verdict}. Below stands why.`];
}

function showMethod() {
    byId("method-text").replaceChildren(...[...referenceSentences(), ...methodSentences()].map((text) => html("p", {}, text)));
}

function referenceSentences() {
    const reference = report.reference;
    if (!reference) {
        return [];
    }
    const target = percent(reference.target);
    const reached = reference.reached ? `the target of ${target} is reached`
        : `the target of ${target} is not reached, so that errors near its noise are partly its own`;
    const noise = METRICS.filter(({key}) => isNumber(reference.noise?.[key])).map(({key, name}) => `${name} ${number(reference.noise[key])}`);
    const set = Object.entries(reference.settings ?? {}).map(([name, value]) => `${name} ${value}`);
    return [
        `The reference is the same scene and view, ${reference.what ?? "with every approximation off"}${set.length > 0 ? ` (${set.join(", ")})` : ""}, the mean of ` +
        `${plural(reference.samples, "sample")} a pixel. Its relative standard error is ${percent(reference.relativeError)}; ${reached}. ` +
        `${noise.length > 0 ? `Its own noise is ${sentenceList(noise)}: no error below that can be measured. ` : ""}` +
        (reference.cached ? "It came from the cache." : `It took ${secondsText(reference.seconds)}.`),
        isNumber(reference.exposure) ? `Pictures and FLIP are shown under an exposure of ${number(reference.exposure)} stops, which is the reference's; so are all errors, in linear light: 1 is white.` : null,
    ].filter((text) => text);
}

function methodSentences() {
    const method = report.method ?? {};
    return [
        `Every point was measured in ${plural(method.rounds, "round")}, each with another seed of its random numbers, after one sample to have its pipelines ready. ` +
        `Within a round the points are measured in random order, ${isNumber(method.batch) ? `in batches of ${count(method.batch)} that each have the default among them, ` : ""}` +
        `so that a machine that slows down slows all of them. The order comes from the seed ${method.seed}, so that a repetition has the same one. ` +
        `The whole took ${secondsText(method.seconds)}${method.quick ? ", in the quick form, which measures less often and at a smaller size" : ""}.`,
        "Times are of the device, from timestamps around the passes of one picture with all its samples. A number is the median over the rounds; in brackets stands the " +
        (method.rounds < 6 ? `whole range of the rounds, as fewer than six hold no ${confidenceText()} confidence interval of a median. `
            : `${confidenceText()} confidence interval of that median, by order statistics, which assumes no distribution. `) +
        "That of the bias is Student's interval of a mean. The time over the default is that of the same round, and a time in milliseconds is this ratio in units of the " +
        "default's median. Where the interval of a ratio to the default, of times or of errors with the same seed, holds 1, the comparison is a tie: one may be better " +
        "than the other, but this measurement does not show it.",
        `The Pareto front holds the points that no other point beats in both time and ${ownMetric().name}. What is tied with the default, or within 1 % of it, counts as the default there.`,
        method.pictureScale > 1 ? `Pictures here are averaged over ${method.pictureScale} × ${method.pictureScale} pixels; those in images/ are whole.` : "",
    ].filter((text) => text);
}
