// Describes the reference and the method in words.

function showMethod() {
    byId("method-text").replaceChildren(...[...referenceSentences(), ...methodSentences(), ...diagnosticSentences()].map((text) => html("p", {}, text)));
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

function diagnosticSentences() {
    return (report.diagnostics ?? []).map((diagnostic) => `Note: ${[diagnostic.where, diagnostic.message, diagnostic.hint].filter((part) => part).join(": ")}`);
}
