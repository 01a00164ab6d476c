/* jolon-world: one function a verb. Each gets its own arguments (argv[0] is the verb), prints its
 * result to standard output and returns an exit code; wrong usage and refusals end the process. */
#ifndef JOLON_WORLDCTL_VERBS_H
#define JOLON_WORLDCTL_VERBS_H

int verb_create(int argc, char **argv);
int verb_repair(int argc, char **argv);
int verb_check(int argc, char **argv);
int verb_info(int argc, char **argv);
int verb_status(int argc, char **argv);
int verb_summary(int argc, char **argv);
int verb_digest(int argc, char **argv);
int verb_dump(int argc, char **argv);
int verb_events(int argc, char **argv);
int verb_list(int argc, char **argv);
int verb_remove(int argc, char **argv);
int verb_pid(int argc, char **argv);
int verb_frame(int argc, char **argv);
int verb_save(int argc, char **argv);
int verb_replay_frame(int argc, char **argv);
int verb_replay(int argc, char **argv);
int verb_diff(int argc, char **argv);

#endif
