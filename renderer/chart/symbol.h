/* Symbols of the map. What a symbol is shows in its form, whose it is in its colour and its rim, so
 * that people who see few colours can tell as well: blue and dark rims are the blue force, red and
 * pale ones the red, yellow and dark ones neutral. Pure. */
#ifndef JOLON_RENDERER_CHART_SYMBOL_H
#define JOLON_RENDERER_CHART_SYMBOL_H

#include "renderer/image/image.h"
#include "world/entity/entity.h"

#include <stdint.h>

struct kind;
struct world;

#define SYMBOL_KINDS_PIXELS 8.5 /* smaller ones tell land, air and sea apart, no more */

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

/* The form that a kind's vehicles have on the map at a size; by its model, else by its domain. */
enum symbol_shape symbol_shape(const struct world *world, const struct kind *kind, double pixels);

struct rgba symbol_colour(enum force force);

/* A vehicle about so long. Within 0.1 of its length around its place it has its force's colour. */
void symbol_vehicle(struct image *image, struct point at, enum symbol_shape shape,
                    double heading_rad, double pixels, enum force force);

void symbol_munition(struct image *image, struct point at, double heading_rad, double pixels);
void symbol_wreck(struct image *image, struct point at, double pixels);
void symbol_fire(struct image *image, struct point at, double pixels);

/* A detonation; age from 0, just now, to 1, when it is gone. */
void symbol_blast(struct image *image, struct point at, double age, double pixels);

void symbol_crater(struct image *image, struct point at, double radius);

#endif
