#pragma once

namespace hybrid_quad {

/// Peak resident memory of the process so far, in MB.
double peak_memory_mb();

/// Resident memory of the process now, in MB.
double resident_memory_mb();

/// Has the C library keep what is freed for what is allocated next, where it would give it back to the system and soon ask for
/// it again, at the price of every page's first touch; on Linux pages are large then, where the system has such (madvise(2)). For a process that ends with its run; the GNU library only.
void keep_freed_memory();

}  // namespace hybrid_quad
