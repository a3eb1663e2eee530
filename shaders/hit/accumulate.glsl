// Samples of a pixel into one value.

// The mean of samples so far: mean + residual, which holds what the rounding of `mean` left out.
struct RunningMean {
    vec3 mean;
    vec3 residual;
};

// The mean of count + 1 values, from that of the first `count` (Welford 1962). Without the residual each step rounds
// the mean anew, and the error grows with the root of the count: to 2e-5 at 100,000 samples, when a step is no larger.
// With it (Kahan 1965) it stays that of one rounding.
RunningMean includeSample(RunningMean last, vec3 value, uint count) {
    precise vec3 change = (value - last.mean - last.residual) / float(count + 1u) + last.residual;
    precise vec3 mean = last.mean + change;
    precise vec3 residual = change - (mean - last.mean);
    return RunningMean(mean, residual);
}

// Whether each part is a number, and not infinite.
bool isFinite(vec3 v) {
    return !(isnan(v.x) || isinf(v.x) || isnan(v.y) || isinf(v.y) || isnan(v.z) || isinf(v.z));
}
