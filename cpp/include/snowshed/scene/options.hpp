// The named choices of a scene. Apart from scene.hpp because the kernels need only these.
#pragma once

namespace snowshed {

enum class Precision { float32, float64 };
enum class SnowModel { cam_clay, elastic };
enum class Transfer { flip, apic };
enum class Basis { quadratic, cubic };
enum class Condition { sticky, slip, separate };
enum class SeedPattern { regular, jittered, poisson };
enum class Between { carry, reseed };

/// Different snows that a scene may have: a particle's is a byte.
inline constexpr int most_snows = 256;

}  // namespace snowshed
