/* Drag functions as tables over the Mach number, linear between their points. */
#include "mover/motion/drag.h"

#include "world/entity/kind.h"
#include "world/maths/maths.h"

#define SEA_DENSITY_KGPM3 1.225
#define SEA_SOUND_MPS     340.294
#define LAPSE_PM          2.25577e-5 /* the share of its absolute temperature lost in a metre */
#define TOP_M             11000.0    /* of the troposphere */

#define MACH_STEP 0.05
#define MACHS     101u /* Mach 0 to 5 */

/* The drag coefficients of the standard projectiles: G1 has a flat base, G7 a long boat tail
 * (Ballistic Research Laboratory; McCoy, Modern Exterior Ballistics, 1999). */
static const double coefficient[DRAG_COUNT][MACHS] = {
    [DRAG_G1] = {0.2629, 0.2558, 0.2487, 0.2413, 0.2344, 0.2278, 0.2214, 0.2155, 0.2104, 0.2061,
                 0.2032, 0.2020, 0.2034, 0.2090, 0.2165, 0.2313, 0.2546, 0.2901, 0.3415, 0.4084,
                 0.4805, 0.5427, 0.5883, 0.6191, 0.6393, 0.6518, 0.6589, 0.6621, 0.6625, 0.6607,
                 0.6573, 0.6528, 0.6474, 0.6413, 0.6347, 0.6280, 0.6210, 0.6141, 0.6072, 0.6003,
                 0.5934, 0.5867, 0.5804, 0.5743, 0.5685, 0.5630, 0.5577, 0.5527, 0.5481, 0.5438,
                 0.5397, 0.5361, 0.5325, 0.5295, 0.5264, 0.5238, 0.5211, 0.5190, 0.5168, 0.5151,
                 0.5133, 0.5119, 0.5105, 0.5095, 0.5084, 0.5076, 0.5067, 0.5061, 0.5054, 0.5047,
                 0.5040, 0.5035, 0.5030, 0.5026, 0.5022, 0.5019, 0.5016, 0.5013, 0.5010, 0.5008,
                 0.5006, 0.5004, 0.5002, 0.5000, 0.4998, 0.4997, 0.4997, 0.4996, 0.4995, 0.4994,
                 0.4994, 0.4993, 0.4992, 0.4992, 0.4991, 0.4991, 0.4990, 0.4990, 0.4989, 0.4989,
                 0.4988},
    [DRAG_G7] = {0.1198, 0.1197, 0.1196, 0.1194, 0.1193, 0.1194, 0.1194, 0.1194, 0.1193, 0.1193,
                 0.1194, 0.1193, 0.1194, 0.1197, 0.1202, 0.1215, 0.1242, 0.1306, 0.1464, 0.2054,
                 0.3803, 0.4043, 0.4014, 0.3955, 0.3884, 0.3810, 0.3732, 0.3657, 0.3580, 0.3510,
                 0.3440, 0.3376, 0.3315, 0.3260, 0.3209, 0.3160, 0.3117, 0.3078, 0.3042, 0.3010,
                 0.2980, 0.2951, 0.2922, 0.2892, 0.2864, 0.2835, 0.2807, 0.2779, 0.2752, 0.2725,
                 0.2697, 0.2670, 0.2643, 0.2615, 0.2588, 0.2561, 0.2533, 0.2506, 0.2479, 0.2451,
                 0.2424, 0.2396, 0.2368, 0.2341, 0.2313, 0.2286, 0.2258, 0.2232, 0.2205, 0.2180,
                 0.2154, 0.2130, 0.2106, 0.2083, 0.2060, 0.2039, 0.2017, 0.1996, 0.1975, 0.1955,
                 0.1935, 0.1916, 0.1898, 0.1879, 0.1861, 0.1844, 0.1827, 0.1810, 0.1793, 0.1777,
                 0.1762, 0.1746, 0.1730, 0.1716, 0.1701, 0.1687, 0.1672, 0.1659, 0.1645, 0.1632,
                 0.1618},
};

/* Returns the absolute temperature over that at sea level. */
static double temperature_ratio(double height_m)
{
    return 1.0 - LAPSE_PM * maths_clamp(height_m, 0.0, TOP_M);
}

/* The standard atmosphere has the power 4.256; 4.25 needs no logarithm. */
double drag_density_ratio(double height_m)
{
    double t = temperature_ratio(height_m), square = t * t;
    return square * square * sqrt(sqrt(t));
}

static double coefficient_at(enum drag_function function, double mach)
{
    double place = maths_clamp(mach / MACH_STEP, 0.0, (double)(MACHS - 1));
    unsigned first = (unsigned)maths_min(place, (double)(MACHS - 2));
    const double *c = &coefficient[function][first];
    return c[0] + (c[1] - c[0]) * (place - (double)first);
}

/* The ballistic coefficient is m / (i d^2), so that the deceleration is
 * pi / 8 rho v^2 Cd(Mach) / BC (McCoy 1999, chapter 5). */
double drag_rate(const struct kind *kind, double speed_mps, double height_m)
{
    if (kind->drag == DRAG_NONE)
        return 0.0;
    double sound = SEA_SOUND_MPS * sqrt(temperature_ratio(height_m));
    double density = SEA_DENSITY_KGPM3 * drag_density_ratio(height_m);
    double shape = coefficient_at((enum drag_function)kind->drag, speed_mps / sound);
    return 0.125 * PI * density * speed_mps * shape / kind->ballistic_kgpm2;
}
