/* Symbols of the map. The shape shows the kind of vehicle. Fill and rim show the force, so that
 * people with defective colour vision can tell them apart as well: blue with a dark rim is the blue
 * force, red with a pale rim the red force, yellow with a dark rim neutral. Pure. */
#ifndef JOLON_RENDERER_CHART_SYMBOL_H
#define JOLON_RENDERER_CHART_SYMBOL_H

#include "renderer/image/image.h"
#include "world/entity/entity.h"

#include <stdint.h>

struct kind;
struct world;

#define SYMBOL_KINDS_PIXELS 8.5 /* smaller symbols distinguish only land, air and sea */

enum symbol_shape {
    SYMBOL_LAND,
    SYMBOL_AIR,
    SYMBOL_SHIP,
    SYMBOL_TANK,
    SYMBOL_CARRIER,
    SYMBOL_TRUCK,
    SYMBOL_JEEP,
    SYMBOL_HELICOPTER,
    SYMBOL_JET,
    SYMBOL_COUNT
};

/* Returns the shape of a kind's symbols of this length: by its model, else by its domain. */
enum symbol_shape symbol_shape(const struct world *world, const struct kind *kind, double pixels);

struct rgba symbol_colour(enum force force);

/* Draws a vehicle of about this length. It has the force's colour within 0.1 of its length around
 * its place. */
void symbol_vehicle(struct image *image, struct point at, enum symbol_shape shape,
                    double heading_rad, double pixels, enum force force);

void symbol_munition(struct image *image, struct point at, double heading_rad, double pixels);
void symbol_wreck(struct image *image, struct point at, double pixels);
void symbol_fire(struct image *image, struct point at, double pixels);

/* Draws a detonation. age: from 0, just now, to 1, when it has faded. */
void symbol_blast(struct image *image, struct point at, double age, double pixels);

void symbol_crater(struct image *image, struct point at, double radius);

#endif
