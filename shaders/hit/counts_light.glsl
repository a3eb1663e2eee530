// Whether rays of lights and of occlusion are counted (RendererOptions::countsLight). It is a specialisation constant, so
// that a driver leaves no code of counters in pipelines that do not count.
layout(constant_id = 1) const bool kCountsLight = false;
