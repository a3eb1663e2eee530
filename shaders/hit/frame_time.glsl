// The time that code of features reads at every stage.
#include "host/material.glsl"

// Returns the seconds that materials may follow.
float frameTime() {
    return hostTime();
}
