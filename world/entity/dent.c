/* The recovery of dents. */
#include "world/entity/dent.h"

double crush_elastic_left(double elastic_m, double age_s)
{
    double x = age_s / DENT_RETURN_S;
    return elastic_m / (1.0 + x * (1.0 + x / 2.0 * (1.0 + x / 3.0 * (1.0 + x / 4.0))));
}
