/* Drag of projectiles by the standard drag functions of exterior ballistics, in the standard
 * atmosphere. Pure functions; any thread. */
#ifndef JOLON_MOVER_MOTION_DRAG_H
#define JOLON_MOVER_MOTION_DRAG_H

struct kind;

/* Returns the air's density over that at sea level, 0..1, at a height over the sea [m]: the
 * standard atmosphere (ISO 2533) up to 11 km, to 0.3 %. */
double drag_density_ratio(double height_m);

/* Returns the rate at which drag takes speed from a munition of the kind [1/s]: its deceleration
 * over its speed. 0 for a kind without a drag function. */
double drag_rate(const struct kind *kind, double speed_mps, double height_m);

#endif
