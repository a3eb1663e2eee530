// Floats at an address, from memory of words. Words beyond the vertex are not read where a vector's last components are
// not used, because the compiler drops them.
vec4 floatsAt(uvec2 address, uint word) {
    UintArray words = UintArray(address);
    return uintBitsToFloat(uvec4(words.data[word], words.data[word + 1u], words.data[word + 2u], words.data[word + 3u]));
}
