DispatchArguments listDispatch(uint count) {
    return DispatchArguments((count + kRayGroupSize - 1u) / kRayGroupSize, 1u, 1u, count);
}

uint bucketOf(HitRecord hit) {
    return hit.geometry == kMissGeometry ? 0u : 1u + FRAME.geometries.data[hit.geometry].shaderId;
}
