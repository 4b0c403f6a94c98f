#pragma once

namespace hybrid_quad {

/// Peak resident memory of the process so far, in MB.
double peak_memory_mb();

/// Resident memory of the process now, in MB.
double resident_memory_mb();

}  // namespace hybrid_quad
