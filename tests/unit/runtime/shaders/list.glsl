DispatchArguments listDispatch(uint count) {
    return DispatchArguments((count + kRayGroupSize - 1u) / kRayGroupSize, 1u, 1u, count, count, 1u, 1u, 0u);
}

uint bucketOf(HitRecord hit) {
    return hit.geometry == kMissGeometry ? 0u : 1u + FRAME.geometries.data[hit.geometry].shaderId;
}
