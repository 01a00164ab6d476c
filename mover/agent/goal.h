/* The goal fields of row i: where its behaviour takes it. Any thread, each its own row. */
#ifndef JOLON_MOVER_AGENT_GOAL_H
#define JOLON_MOVER_AGENT_GOAL_H

#include "mover/context/step_context.h"

/* The next goal of a patrol or route. After an interruption the order resumes: a route with the
 * same goal again, a script with the step for the time, a patrol with the next goal. */
void goal_next(const struct step_context *context, uint32_t i);
void goal_resume(const struct step_context *context, uint32_t i);

/* A goal at a distance in a direction. */
void goal_away(const struct step_context *context, uint32_t i, double heading, double distance);

/* A goal away from an enemy's row: the nearest place found that the enemy cannot see, else a far
 * one. */
void goal_cover(const struct step_context *context, uint32_t i, uint32_t enemy);

/* A firing position within 90 m: if there is one, a place from which row i sees the enemy's row
 * while the ground or a building hides its hull; else a place where it is hidden, or beside it.
 * goal_cover_near() returns true if nothing hides it where it is, and there is a place that does;
 * goal_hull_down() if it is at such a place, with its gun in sight; goal_in_position() if the
 * vehicle is at its place. */
void goal_position(const struct step_context *context, uint32_t i, uint32_t enemy);
bool goal_cover_near(const struct step_context *context, uint32_t i, uint32_t enemy);
bool goal_hull_down(const struct step_context *context, uint32_t i, uint32_t enemy);
bool goal_in_position(const struct step_context *context, uint32_t i);

/* Makes that row its target, and the place of the target its goal. The crew needs a time of
 * reaction before it fires at a new target. */
void goal_target(const struct step_context *context, uint32_t i, uint32_t row, uint32_t id);

/* Makes the base of its force its goal. Returns true if it is there; a ship has arrived where the
 * water ends. */
void goal_base(const struct step_context *context, uint32_t i);
bool goal_at_base(const struct step_context *context, uint32_t i);

/* Returns true if it is as near to its goal as a body of its kind can get; of a land vehicle whose
 * patrol or route is smaller than 100 m, as a third of that. */
bool goal_arrived(const struct step_context *context, uint32_t i);

/* Returns true if its patrol or route is so small that all its goals are one place. */
bool goal_is_place(const struct step_context *context, uint32_t i);

/* Chooses another goal after the path was blocked. */
void goal_blocked(const struct step_context *context, uint32_t i);

#endif
