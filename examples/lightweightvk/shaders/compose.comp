// Adds the light of both rays to each pixel, bounded against fireflies, and shows the mean of all frames.
layout(local_size_x = 64) in;
void main() {
    uint pixel = gl_GlobalInvocationID.x;
    for (uint i = 2u * pixel; i < 2u * pixel + 2u && pixel < frame.width * frame.height; ++i) {
        frame.sums.data[pixel].rgb += min(frame.weights.data[i].rgb * frame.answers.data[i].rgb, vec3(4.0));
        vec3 tone = 1.0 - exp(-0.75 / float(frame.number + 1u) * frame.sums.data[pixel].rgb);
        frame.picture.data[pixel] = packUnorm4x8(vec4(pow(tone, vec3(1.0 / 2.2)), 1.0));
    }
}
