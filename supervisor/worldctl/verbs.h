/* The verbs of jolon-world, one function each. A verb gets the arguments that main.c's table allows
 * it, prints its result to standard output and returns an exit code. Wrong usage and refusals end
 * the process. */
#ifndef JOLON_SUPERVISOR_WORLDCTL_VERBS_H
#define JOLON_SUPERVISOR_WORLDCTL_VERBS_H

struct arguments;

int verb_create(const struct arguments *arguments);
int verb_repair(const struct arguments *arguments);
int verb_check(const struct arguments *arguments);
int verb_info(const struct arguments *arguments);
int verb_status(const struct arguments *arguments);
int verb_summary(const struct arguments *arguments);
int verb_digest(const struct arguments *arguments);
int verb_dump(const struct arguments *arguments);
int verb_events(const struct arguments *arguments);
int verb_list(const struct arguments *arguments);
int verb_paths(const struct arguments *arguments);
int verb_remove(const struct arguments *arguments);
int verb_sweep(const struct arguments *arguments);
int verb_pid(const struct arguments *arguments);
int verb_frame(const struct arguments *arguments);
int verb_save(const struct arguments *arguments);
int verb_replay_frame(const struct arguments *arguments);
int verb_replay(const struct arguments *arguments);
int verb_diff(const struct arguments *arguments);

#endif
