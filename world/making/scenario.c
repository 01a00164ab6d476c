/* Freeing a scenario; config/loader.c reads it. */
#include "world/making/scenario.h"

#include <stdlib.h>
#include <string.h>

void scenario_free(struct scenario *scenario)
{
    free(scenario->settings);
    free(scenario->kinds);
    free(scenario->models);
    free(scenario->vertices);
    free(scenario->triangles);
    free(scenario->hulls);
    free(scenario->hull_vertices);
    free(scenario->hull_planes);
    free(scenario->groups);
    free(scenario->object_list);
    free(scenario->earthworks);
    free(scenario->fires);
    free(scenario->scripts);
    free(scenario->steps);
    free(scenario->objectives);
    free(scenario->missions);
    free(scenario->phases);
    free(scenario->areas);
    free(scenario->routes);
    free(scenario->route_points);
    provenance_free(&scenario->recipe);
    memset(scenario, 0, sizeof(*scenario));
}
