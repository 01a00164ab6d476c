/* Compression and rebound of the spring in closed form. */
#include "collider/solver/contact_spring.h"

#include "world/maths/maths.h"

double contact_spring_in_series(double a_npm, double b_npm)
{
    return a_npm * b_npm / (a_npm + b_npm);
}

struct contact_spring_impact contact_spring_impact(const struct contact_spring *spring)
{
    double per_radian = sqrt(spring->reduced_kg / spring->stiffness_npm);
    double depth = spring->closing_mps * per_radian;
    double restitution = spring->restitution;
    return (struct contact_spring_impact){
        .impulse_ns = spring->reduced_kg * spring->closing_mps * (1.0 + restitution),
        .depth_m = depth,
        .left_m = depth * (1.0 - restitution * restitution),
        .force_n = spring->stiffness_npm * depth,
        .duration_s = HALF_PI * per_radian * (1.0 + restitution),
    };
}
