#!/usr/bin/env bash
# mutations.sh - break the code on purpose, one place at a time, and see that a suite near it fails: make mutations.
# The tree is copied and built once; every mutation is made in the copy by sed, built, tried and undone.
# mutations.sh NAME... tries those whose names begin so; mutations.sh --made only that each finds what it is to change.
# SPDX-License-Identifier: MIT
set -u
top=$(cd "$(dirname "$0")/.." && pwd)

# name | file | what sed does | suites
table() {
    sed '/^$/d' <<'END'
products of near groups | examples/oracles/power.dag | s/\(product *: ratio = \)5e-8/\12.5e-5/ | runtime/check_power_scenes
bends are never known | runtime/engine/solve.c | s/\&\& !rays_in_the_way(p->rays);/\&\& 0;/ | runtime/check_bends
bends are always balanced | runtime/tools/linear_gap.h | s/together > limit \&\&/0 \&\&/ | runtime/check_bends runtime/check_power runtime/check_power_scenes
bends of the last link | runtime/engine/bends.c | s/at->point.i..k. += factor/at->point[i][k] = factor/ | runtime/check_bends
bends at centre and corners alone | runtime/engine/bends.c | s/return sqrt(square . INSIDE);/return 0 * square;/ | runtime/check_bends
bends that hand does not read | tests/hand/power.c | s/{FACT_RECEIVER_BEND};/{FACT_RECEIVER_AREA};/ | runtime/check_bends
bends seen by nobody | runtime/engine/bends.c | s/in->changed.i. .= (unsigned char)/in->changed[i] += 0 * (unsigned char)/ | runtime/check_bends
leaves without end | runtime/kernel/constants.h | s/#define MEND_LEAVES (16/#define MEND_LEAVES (256/ | runtime/check_detail
quarters that say nothing | runtime/engine/mend_solution.c | s/fmin(MEND_DETAIL \* goal->linked, 1)/1.0/ | runtime/check_detail
dim faces at each look | runtime/engine/mend_solution.c | s/goal->look$/goal->look < 0/ | solver/check_asked
the middle of an interval | solver/commands/accuracy.c | s/fmax(e->l1_faces.high, m->alone.noise.high)/e->l1_faces.value/ | solver/check_asked
bands that particles know | runtime/engine/face_error.c | s/band_noise.k. = mean/band_noise[k] = 0 * mean/ | solver/check_bands
parts of two walls | runtime/engine/dim_parts.c | s/p->reach \* e->normal.k - 3.;/0 * e->normal[k - 3];/ | runtime/check_dim_faces
groups that nobody is told of | runtime/engine/mend_solution.c | s/^    dim_count_add(.*$/    (void)groups;/ | runtime/check_dim_faces
light of a black sky for all light | runtime/catalog.dag | s/0.5 \* d->receiver->area \* (1 + d->receiver->reflectance . d->host->mean_reflectance)/d->receiver->area/ | runtime/check_power_scenes
groups as white as nothing | runtime/engine/oracle_inputs.c | s/i > 0 \&\& e->reflectance/i < 0 \&\& e->reflectance/ | runtime/check_power_scenes
leaves that nobody counted on | solver/commands/error_summary.c | s/return o->out .. o->image_error;/return o->out != NULL;/ | solver/check_asked
walls that stand in their own way | runtime/visibility/outer_walls.c | s/if (low < w->behind)/if (low > w->behind)/ | runtime/check_free_space
shafts beside a flat cluster | runtime/visibility/candidates.c | s/low >= apart - shaft->touch/low >= -1e9 * shaft->touch/ | runtime/check_flat_clusters
ends that lie flat on a flat cluster | runtime/visibility/candidates.c | s/if (end_low < near/if (0 * near > 0/ | runtime/check_flat_clusters
planes that lean | runtime/hierarchy/flat_clusters.c | s/fmax(fabs(over + high), fabs(over + low))/fabs(over)/ | runtime/check_flat_clusters
what lies flat on a wall | runtime/visibility/outer_walls.c | s/return low < w->near \&\&/return 0 * low < 0 \&\&/ | runtime/check_free_space
ears forget the corner before | runtime/hierarchy/polygon.c | s/sides_of(r, \&t, last, from);/;/ | runtime/check_triangles
ears know but half of a box | runtime/hierarchy/polygon.c | s/p_beyond \& last_beyond/p_beyond + last_beyond/ | runtime/check_triangles
all planes are parallel | runtime/hierarchy/cut_contacts.c | s/square <= 0.25/square <= 1e5/ | runtime/check_cut
all faces are parts of one polygon | runtime/hierarchy/overlaps.c | s/of.n->child + k. == of.i. ? of.i. : MIXED/f->input/ | runtime/check_overlaps
dark pieces hide no light | runtime/engine/sight_cubature.c | s/!l->limits.many \&\& node->count > 1/!l->limits.many \&\& node->count > 1000/ | runtime/check_entries
what is close behind a lamp is solid | runtime/hierarchy/body_rim.c | s/p.back >= MOST \* p.length/p.back >= -1/ | runtime/check_stacked
rims end where faces are cut | runtime/hierarchy/body_rim.c | s/return p->rim->known\[stretch->face\] ? 0 : add(p, stretch->face);/;/ | runtime/check_stacked
boxes stay out | runtime/visibility/standing.c | s/if (low >= 0)/if (low >= -1)/ | runtime/check_contact
packets look for no fronts | runtime/visibility/ray_hits.c | s/fronts_there(rays, &query, backs)/fronts_there(rays, \&query, 0)/ | runtime/check_contact
slides past what stands | runtime/visibility/rays.c | s/return stood == STOOD_ON;/return stood < 0;/ | runtime/check_dark_sides
shafts of empty rooms | runtime/visibility/rays.c | s/return free_space_is_all(&rays->free)$/return 0/ | runtime/check_bends
rows scaled alike | runtime/engine/row_sums.c | s/own > cap ? cap \/ own : 1/row > cap ? cap \/ row : 1/; s/row <= cap ? 1 : own < cap ? (cap - own) \/ above : 0/row > cap ? cap \/ row : 1/ | runtime/check_transport runtime/check_closure runtime/check_solve
groups pay nothing | runtime/engine/row_sums.c | s/if (rows.sum > most \* rows.area)/if (0 \&\& rows.sum > most * rows.area)/ | runtime/check_transport
groups pay all | runtime/engine/row_sums.c | s/fmax(0, (most \* rows->area - sure) \/ (all - sure))/0 * most/ | runtime/check_transport
what sees nothing is looked at | runtime/engine/dim_paths.h | s/p->sighted == 0/p->sighted > p->paths/ | runtime/check_dim_faces
middles of parts lie on edges | runtime/engine/sight_outlines.c | s/1 + hash_unit((uint64_t)i)/1 + 0 * hash_unit((uint64_t)i)/ | runtime/check_outlines
shades seen from the edge tell | runtime/engine/sight_missed.c | s/> EDGE_ON \* radius/>= 0 * radius/ | runtime/check_sheets
the ray in a joint speaks for all | runtime/engine/sight_between.c | s/line < 3; line/line < 1; line/ | runtime/check_sheets
paths are looked at once | runtime/engine/path_mending.c | s/(again /(1 / | runtime/check_path_mending
replicates of paths share their points | runtime/particles/face_paths.c | s/REPLICATES + r, shift/REPLICATES, shift/ | runtime/check_paths
what a path takes where light is reflected often | runtime/engine/path_mending.c | s/count > 0 ? 2 . (double)/count > 0 ? 0 * (double)/ | runtime/check_path_mending
a look that is a part of what there may be | runtime/engine/path_mending.c | s/fmin(cost . PATHS_LOOK, most . PART)/fmin(cost, most) \/ PATHS_LOOK/ | runtime/check_path_mending
a look at any price | runtime/engine/path_mending.c | s/fmin(cost . PATHS_LOOK, most . PART)/(cost \/ PATHS_LOOK)/ | runtime/check_path_mending
paths are held against particles that saw nothing | runtime/engine/path_mending.c | s/fmax(of_particles, tally_power_of_one(particles) . by_paths)/fmax(of_particles, 0 * by_paths)/ | runtime/check_path_mending
paths miss nothing | runtime/particles/particles.h | s/tally->faces . (all \* all) : 0/0 * tally->faces \/ (all * all) : 0/ | runtime/check_path_mending
nothing seen is nothing there | runtime/engine/reflected_light.c | s/        \*variance = tally_power_of_one/        *variance = 0 * tally_power_of_one/ | runtime/check_unseen_light
faces are surer than all light | runtime/engine/dim_belief.h | s/variance + d->shared \* light/variance + 0 * d->shared * light/ | runtime/check_unseen_light
what nobody has found light on is dark | runtime/engine/dim_belief.h | s/light > 0 \&\& variance/variance/ | runtime/check_unseen_light
planes prove nothing | runtime/engine/lights_reach.c | s/^    return reach;/    return 1;/ | runtime/check_unseen_light
all colours are one | runtime/engine/lights_reach.c | s/(answers(p, white\[j\], i) \&\& /(/ | runtime/check_unseen_light
one face in twenty is few | runtime/engine/dim_plan.c | s/most - left)/rays - left)/ | runtime/check_dim_plan
covered faces are looked at | runtime/engine/dim_list.c | s/? uncovered \*/? (uncovered >= 0) */ | runtime/check_dim_faces
no paths for the rest | runtime/engine/dim_plan.c | s/p->wanted += (uint64_t)paths_for(d, p, goal);/(void)goal;/ | runtime/check_dim_plan
split particles tell of dim faces alone | runtime/engine/dim_faces.c | s/^ *.. mend_again(.*$/        ;/ | runtime/check_split
replicates that agree know a band | runtime/engine/face_error.c | s/fmax(noise, c->most.row.)/noise/ | runtime/check_measured_error
windows are of all light | runtime/engine/dim_faces.c | s/near_power(fmax(here.k. /near_power(fmax(all / | runtime/check_dim_faces
who counts anew starts from what was not settled | runtime/engine/mend_clusters.c | s/        if (mend_is_here(/        if (!before \&\& mend_is_here(/ | runtime/check_split
who mended before knew nothing | runtime/engine/mend_clusters.c | s/fmax(least, x->best/fmax(0 * least, x->best/ | runtime/check_split
paths change light that ends there | runtime/engine/dim_faces.c | s/p->reflects.band. ? dim_mean/1 ? dim_mean/ | runtime/check_dim_faces
weak lamps are gathered in a few | runtime/particles/particles.c | s/f.least = fmin(tally->least, tally->carried.light.)/f.least = tally->least/ | runtime/check_split
tiles are as dim as they are small | runtime/engine/dim_faces.c | s/p->told = doubt_of(d, faces.doubt, p) <= DIM_GOAL/p->told = doubt_of(d, faces.doubt, p) < 0/ | runtime/check_dim_faces
small faces that no ray asks are known | runtime/engine/dim_faces.c | s/if (p->asked .. p->told)/if (p->asked < 2)/ | runtime/check_dim_faces
what nobody knows is not wrong | solver/commands/error_summary.c | s/m->mended \&\& r->unsure > 0)/0 \&\& r->unsure > 0)/ | solver/check_summary
paths that agree miss nothing | runtime/engine/dim_belief.c | s/DIM_MISSED)/1e9)/ | runtime/check_dim_plan
near as far | runtime/terms/visibility.h | s/dot3(apart, apart) < wide \* wide/dot3(apart, apart) < 0 * wide/ | runtime/check_runtime
shadow .05 | runtime/kernel/constants.h | s/\(ROW_SHADOW\) *0.5$/\1 0.05/ | runtime/check_transport runtime/check_closure runtime/check_solve
rough .2, settled 5 | runtime/kernel/constants.h | s/\(ROUGH_TOLERANCE\) *0.005$/\1 0.2/; s/\(SETTLED\) *1000$/\1 5/ | runtime/check_transport runtime/check_clusters
rough .2 | runtime/kernel/constants.h | s/\(ROUGH_TOLERANCE\) *0.005$/\1 0.2/ | runtime/check_transport runtime/check_clusters
settled 5 | runtime/kernel/constants.h | s/\(SETTLED\) *1000$/\1 5/ | runtime/check_transport runtime/check_clusters
stop three times looser | runtime/engine/transport.c | s/x->bound \/ x->held/x->bound \/ (3 * x->held)/ | runtime/check_transport runtime/check_solve
a fifth for a tenth | runtime/kernel/constants.h | s/\(SOLVE_SHARE\) *0.1$/\1 0.2/ | runtime/check_transport
first child only | runtime/engine/variation.c | s/            for (int c = 0; c < e->children; c++) {/            for (int c = 0; c < 1; c++) {/ | runtime/check_transport
guesses by shares of the light | runtime/engine/transport.c | s/factor(&guess, x->moved)/factor(\&guess, x->residual)/ | runtime/check_solvers
slopes guessed by shares of the light | runtime/engine/linear_transport.c | s/factor(&guess, m->moved)/factor(\&guess, m->residual)/ | runtime/check_linear
shots lose parts | runtime/engine/southwell.c | s/links += send(s, op, x, at->child + (uint32_t)c)/links += at->depth > 0 ? 0 : send(s, op, x, at->child + (uint32_t)c)/ | runtime/check_solvers
light waits for ever | runtime/engine/southwell.c | s/        s->unshot\[i\] += s->fresh\[i\]/        s->unshot[i] = s->fresh[i]/ | runtime/check_solvers
ambient light twice | runtime/engine/southwell.c | s/ambient\[k\] \/ (area - rho\[k\])/4 * ambient[k] \/ (area - rho[k])/ | runtime/check_solvers
nothing is sent afar | runtime/engine/southwell.c | s/s->afar\[(size_t)e \* s->bands + k\] += unshot\[k\]/(void)0/ | runtime/check_solvers
LU without shares | runtime/engine/dense.c | s/double sum = share \* d->shared\[j\]/double sum = 0 * share/ | runtime/check_solvers
LU of one band | runtime/engine/dense.c | s/face \* x->bands + k\];/face * x->bands];/ | runtime/check_solvers
angles turned too late | runtime/kernel/plain_math.h | s/least > 0.26 \* most/least > 0.5 * most/ | runtime/check_plain_math
logarithms with a term less | runtime/kernel/plain_math.h | s/double r = 0.146178813838630361511;/double r = 0;/ | runtime/check_plain_math
centres of one corner | runtime/engine/collocation.c | s/point_factor(r, s)/0.5 * (link->form_factor + point_factor(r, s))/ | runtime/check_projection
faces take their mean | runtime/engine/separable_links.c | s/return c->centres ? separable_kernel_at_centre(faces, i, &b->s)/return c->centres \&\& 0 ? separable_kernel_at_centre(faces, i, \&b->s)/ | runtime/check_solvers
backs 8 of 8 | runtime/kernel/constants.h | s/\(CONTACT_BACKS\) *6$/\1 8/ | runtime/check_runtime runtime/check_transport runtime/check_cut runtime/check_closure
no plain pivots | runtime/engine/pivots.c | s/round_weight, &first, PASSING_PLAIN)/round_weight, \&first, PASSING)/ | runtime/check_separable_links runtime/check_clusters
shares of links back to front | runtime/engine/refine_order.c | s/(size_t share = 0; share < s.shares; share++) {/(size_t share = s.shares; share-- > 0;) {/ | runtime/check_clusters
nobody is waited for | runtime/util/thread_pool.c | s/while (l->inside)/while (0 \&\& l->inside)/ | runtime/check_thread_pool
all helpers are waited for | runtime/util/thread_pool.c | s/while (l->inside)/while (l->inside + (l->joined < l->room))/ | runtime/check_thread_pool
helpers spin | runtime/util/thread_pool.c | s/pthread_cond_wait(&pool.open, &pool.lock)/pthread_mutex_unlock(\&pool.lock), pthread_mutex_lock(\&pool.lock)/ | runtime/check_thread_pool
children keep helpers | runtime/util/thread_pool.c | s/pool = nobody;/(void)nobody;/ | runtime/check_thread_pool
moves not made again | solver/util/pattern_search.c | s/to->at\[i\] - from->at\[i\]/0 * (to->at[i] - from->at[i])/ | solver/check_tune
held by nothing | solver/commands/tune_choice.c | s/penalty \* far : 0/0 * far : 0/ | solver/check_tune
all search at once no more | solver/util/pattern_search.c | s/(s->together \&\& s->count > 1)/0/ | solver/check_tune
left out and yet seen | solver/commands/tune_fit.c | s/if (s == f->left_out)/if (0)/ | solver/check_tune
comments are read | solver/util/graph_defaults.c | s/if (\*at != '#')/if (1)/ | solver/check_tune
terms noted once | runtime/oracle/counting.c | s/        t->levels\[i \/ 8\] = now;/        (void)t;/ | runtime/check_statistics
passes from the beginning | runtime/oracle/statistics.c | s/i > 0 ? numbers - p->number_count : NULL/NULL/ | runtime/check_statistics solver/check_draw
times not scaled | runtime/oracle/statistics.c | s/\* (double)calls \/ (double)timed : 0/* (double)(calls > 0) : 0/ | runtime/check_statistics
rays of all nodes before | runtime/oracle/counting.c | s/t->host.rays - rays/t->host.rays + 0 * rays/ | runtime/check_instrumented
dead arcs alive | solver/output/graph_drawing.c | s/.dead = counted \&\& count == 0/.dead = 0/ | solver/check_draw
arcs to the first leaf | solver/output/graph_drawing.c | s/            a->leaf = (int)i;/            a->leaf = 0;/ | solver/check_draw
behind though some is in front | runtime/kernel/cluster_samples.h | s/a->normal) + 1.001 \* s->radius/a->normal) + 0.5 * s->radius/ | runtime/check_cluster_walk
a sample less | runtime/kernel/cluster_samples.h | s/(tried + 0.5) \* cluster_step/(tried + 1.5) * cluster_step/ | runtime/check_cluster_walk
pierced through edges' lines | runtime/kernel/shaft_pierced.h | s/+ g.z\[1\] \* c2 > g.at\[1\]/+ g.z[1] * c2 > g.at[1] - 0.3/ | runtime/check_pierced
pierced from one side | runtime/kernel/shaft_pierced.h | s/(a \* other < 0)/(a * other != 0)/ | runtime/check_pierced
bent and pierced | runtime/kernel/shaft_pierced.h | s/0.25 \* shaft->slack/shaft->flat/ | runtime/check_pierced
kept for another cluster | runtime/kernel/cluster_samples.h | s/if (w->child\[at\] != e->child)/if (!w->child[at])/ | runtime/check_cluster_walk
the last child is passed by | runtime/kernel/cluster_samples.h | s/place\[k\] < last/place[k] <= last/ | runtime/check_cluster_walk
no chance of a child's | runtime/kernel/cluster_samples.h | s/all \*= p->share\[k\];/all *= p->share[0];/ | runtime/check_cluster_walk
roots that are forgotten | runtime/kernel/cluster_batch.h | s/w->pair\[j\]->root\[0\] = w->pair\[j\]->root\[1\] = NULL/(void)j/ | runtime/check_cluster_walk
spots of the pair before | runtime/tools/cluster_visibility.wave.h | s/p->root\[0\] = p->root\[1\] = NULL;/(void)0;/ | runtime/check_cluster_walk
a chance begun anew | runtime/kernel/cluster_batch.h | s/now->chance\[still\] = chance/now->chance[still] = 1/ | runtime/check_cluster_walk
children that are not there | runtime/kernel/cluster_spots.h | s/p->part\[k\] = place\[k\] < children ? part : 0/p->part[k] = part/ | runtime/check_cluster_walk
what is known is cast again | runtime/tools/cluster_visibility.wave.h | s/if (d->terms.visibility_level >= level)/if (0)/ | runtime/check_cluster_walk
moved off twice as far | runtime/kernel/cluster_batch.h | s/x->at\[k\]\[at\] + off \*/x->at[k][at] + 2 * off */ | runtime/check_cluster_walk
columns out of order | runtime/kernel/rows.h | s/column\[1\] = __builtin_shufflevector(f, h, 0, 1, 4, 5)/column[1] = __builtin_shufflevector(f, h, 0, 1, 5, 4)/ | runtime/check_cluster_walk
rules without their last points | runtime/engine/linear_coupling.c | s/at->count; i += FEW/at->count - FEW + 1; i += FEW/ | runtime/check_linear
quarters of strips | runtime/engine/linear_coupling.c | s/is_long(.c->e) ? 2 : 4/is_long(\&c->e) ? 4 : 4/ | runtime/check_linear
halves cut along | runtime/engine/linear_coupling.c | s/edge\[1\] > edge\[0\], b = /edge[1] < edge[0], b = / | runtime/check_linear
the emitter's slopes mixed | runtime/engine/linear_coupling.c | s/sum_2\[k\] += sent \* phi_2/sum_2[k] += sent * (phi_2 + 0.1 * phi_1)/ | runtime/check_linear
seen from the other's front | runtime/engine/linear_coupling.c | s/(at, r->e.normal/(at, s->e.normal/ | runtime/check_linear
an interpreter that links | runtime/oracle/interpreter.c | s/return (enum decision) ~next;/return (enum decision)(~next == 1 ? 0 : ~next);/ | dagc/check_prove
interpreter: arcs of the first | runtime/oracle/interpreter.c | s/: dag->nodes\[t->index\].order;/: dag->nodes[t->index].order + (i == 0 \&\& k == 0);/ | dagc/check_prove
defaults emitted 7 | dagc/emit/emit_c.c | /static void print_value/,/^}/s/dag_print_number(out, parameter->value)/dag_print_number(out, 7)/ | dagc/check_prove
tables emitted 7 | dagc/emit/emit_c.c | /static void print_parameter_table/,/^}/s/dag_print_number(out, parameter->value)/dag_print_number(out, 7)/ | dagc/check_prove
offsets of the first | dagc/emit/emit_c.c | s/is_integer(dag, parameter), oracle->name, parameter->name);/is_integer(dag, parameter), oracle->name, dag->parameters[oracle->parameters.first].name);/ | dagc/check_prove
fingerprints of nothing | dagc/emit/emit_c.c | s/dag_fingerprint_text(oracle, fingerprint);/memset(fingerprint, '0', 16), fingerprint[16] = 0;/ | dagc/check_prove
known too early | dagc/emit/flat_node.c | s/dag_flat_level(dag, t, low));$/dag_flat_level(dag, t, t->levels.count > 0 ? t->levels.count : 1));/ | dagc/check_prove
counted and decided otherwise | runtime/oracle/counting.c | s/return (enum decision) ~p->next\[at\];/return (enum decision)(~p->next[at] == 1 ? 0 : ~p->next[at]);/ | runtime/check_releases
followed and decided otherwise | runtime/oracle/follow.c | s/return (enum decision) ~next;/return (enum decision)(~next == 1 ? 0 : ~next);/ | runtime/check_releases
differences are timed | solver/commands/compare.c | s/    if (!p->differences)$/    if (1)/; s/    if (panel.differences) {/    if (0) {/ | solver/check_compare
fixed and yet set | runtime/oracle/refiner.c | s/if (p->fixed)/if (0)/ | runtime/check_api solver/check_params
parameters set twice | solver/util/parameter_file.c | s/if (f->lines\[i\])/if (0)/ | solver/check_params
VTK: letters are bytes | solver/scene/vtk_arrays.c | s/more + 2) . 3 . 4/more)/ | solver/check_mesh_formats
VTK: lengths of appended arrays are believed | solver/scene/vtk_arrays.c | s/. 3 : left)/* 3 : more)/ | solver/check_mesh_formats solver/check_mesh_refusals
VTK: no array is of nothing | solver/scene/vtk_arrays.c | s/count .. bytes == 3 . word ?/count ?/ | solver/check_mesh_formats
VTK: low bytes first | solver/scene/read_vtk.c | s/v->type->size, 1)/v->type->size, 0)/ | solver/check_mesh_formats
VTK: short strings alone | solver/scene/read_vtk.c | s/size = 8 >> (first >> 6)/size = 1 + 0 * first/ | solver/check_mesh_formats
Gmsh: an element for each group | solver/scene/read_gmsh.c | s/if (n > 1 \&\& /if (n > 1 \&\& 0 \&\& / | solver/check_mesh_formats
Nastran: lines of other files | solver/scene/read_nastran.c | s/return a->depth ? 0 :/return a->depth < 0 ? 0 :/ | solver/check_mesh_formats
Nastran: repeated cards pass | solver/scene/read_nastran.c | s/if (.first == '=')/if (*first == 1)/ | solver/check_mesh_refusals
glTF: any extension will do | solver/scene/gltf_materials.c | s/!is_harmless(/0 \&\& !is_harmless(/ | solver/check_scene
libraries: the first counts | solver/scene/name_slots.c | s/^    \*slot_of(s, names, names\[i\]) = i;/    if (is_new) &/ | solver/check_damaged
damage of a state unseen | runtime/engine/state_stream.c | s/check == wanted ? STATE_READ/wanted + 1 ? STATE_READ/ | runtime/check_exchange_state
more behind a state | runtime/engine/exchange_state_read.c | s/judge(s, state_get_end(&s->in)) < 0/0/ | runtime/check_exchange_state
a block of a state is left out | runtime/engine/exchange_fill.c | s/(i >= f->read/(i > f->read/ | runtime/check_exchange_state
a state of other parameters | runtime/engine/state_identity.c | s/hash = hash_bytes(hash, &value, sizeof value);/(void)value;/ | runtime/check_exchange_state
few sweeps, and links are blamed | solver/util/solved.c | s/ \&\& !(r->solved.bound > r->solved.tolerance)/ \&\& r->solved.bound >= 0/ | solver/check_summary
screens of one side | solver/output/faces_table.c | s/t->area.t->count. .= sides;/t->area[t->count] *= 0 * sides + 1;/ | solver/check_error
unfinished, not told       | solver/util/solved.c | s/return 3;/return 0;/ | solver/check_lost_work
a proof's folder stays     | dagc/prove/compile.c | s/dag_tidy_push(&tidy);/(void)tidy;/ | dagc/check_signals
a slow disk is a hang       | solver/scene/import_child.c | s/") D"/") Q"/ | solver/check_import_child
nobody slips               | solver/util/near_name.c | s/length \/ 3 + 2/0/ | solver/check_options solver/check_params
imports are outputs        | solver/commands/check_outputs.c | s/return radListOracleFiles.*/return 0;/ | solver/check_options
panel: texts are markup | solver/output/panel_page.c | s/strchr("<>&", \*at)/strchr("\&", *at)/ | solver/check_panel
panel: wrong files taken | solver/panel/result.js | s/if (wrong.length) throw/if (false) throw/ | solver/check_panel
panel: all nodes are stops | solver/panel/graph.js | s/i ? "-1" : "0"/"0"/ | solver/check_panel
panel: words unquoted | solver/panel/result.js | s/words.map(quoted)/words/ | solver/check_panel
clear too soon | runtime/engine/element_error.c | s/j->squares = 2 \* log/j->squares = 0.4 * log/ | runtime/check_element_error
parts know nothing of what is around | runtime/engine/element_error.c | s/j->say\[above\].told ? share_of/j->say[above].told ? 0 * share_of/ | runtime/check_element_error
parts that are right stay parts | runtime/engine/element_error.c | s/s->told = is_wrong(j, polygon_of(j, e), &s->part)/s->told = 1/ | runtime/check_element_error
limits without noise | runtime/engine/element_error.c | s/ELEMENT_ERROR_LIMIT \* sqrt/0.01 * sqrt/ | runtime/check_element_error
bands by themselves | runtime/engine/face_error.c | s/noise += c->deviation\[j\]/noise = hypot(noise, c->deviation[j])/ | runtime/check_element_error
what is covered is handed light | runtime/engine/operator.h | s/return op->uncovered\[e\] > 0 ? op->uncovered\[j\] \/ op->uncovered\[e\] : 1;/return 1 + 0 * op->uncovered[e + 0 * j];/ | runtime/check_transport
sets have the slope of all | runtime/particles/power_balance.c | s/LEFT_OUT \* q \* p/0 * q * p/; s/LEFT_OUT \* q \* q/0 * q * q/ | runtime/check_power_balance
what leaves is still here | runtime/particles/power_balance.c | s/= ended\[k\] + unit/= ended[k] + 0 * unit/ | runtime/check_power_balance
leaves know no balance | runtime/particles/particles.h | s/(1 + tally->correction\[REPLICATES\]\[band\])/1/ | runtime/check_power_balance
hidden at its middle, hidden all over | runtime/engine/sight_outlines.c | s/met &= sight_faces_met/(void)sight_faces_met/ | runtime/check_outlines
half of what stands before a piece | runtime/engine/sight_cubature.c | s/memcpy(list_of(l, at), b->list, (size_t)b->faces/& \/ 2/ | runtime/check_outlines
counted by nobody, surely nothing | runtime/engine/mend_clusters.c | s/known \* noise + (1 - known) \* chance/noise/ | runtime/check_measured_error
the worst of all thresholds | runtime/engine/mend_clusters.c | s/r->left\[i\] < r->left\[best\]/r->left[i] > r->left[best]/ | runtime/check_mended_error
thresholds that noise chooses | runtime/engine/mend_clusters.c | s,? 4 \* h / children \* note->replicates,? 0 * h / children, | runtime/check_mended_error
noise of corners is shown | solver/output/smoothing.c | s/1 - SMOOTHING_THRESHOLD \*/1 - 0 */ | solver/check_smoothing
edges are noise | solver/output/smoothing.c | s/share = fmax(0,/share = 0 * fmax(0,/ | solver/check_smoothing
neighbours however far | solver/output/smoothing.c | s/\*of_a = far_b .*/*of_a = 0.5;/ | solver/check_smoothing
counts that disagree are as sure | runtime/engine/mended_reach.c | s/apart \* apart \/ both)/0 * apart)/ | runtime/check_mended_reach
mending is a third of what it is | runtime/engine/mended_reach.c | s/reach->l1 = left/reach->l1 = 0.3 * left/ | runtime/check_mended_reach
large faces are as good as links | runtime/engine/mended_error.c | s/noise->large + small->value/0 * &/ | runtime/check_mended_error
believed as if for certain | runtime/engine/mend_risk.c | s/ += 4 \* h \* along/ += 0 * h * along/ | runtime/check_mended_error
what is left is what is likely | runtime/engine/mend_risk.c | s/deviation = sqrt(/deviation = 0 * sqrt(/ | runtime/check_mended_error
noise is none where it is believed | runtime/engine/mend_risk.c | s/u \* (2 \* h - 1) \* noise/u * noise/ | runtime/check_mended_error
far sides the other way round | runtime/hierarchy/long_faces.c | s/back ? 3 - c : c/c/ | runtime/check_long_faces
short sides are cut | runtime/hierarchy/long_faces.c | s/sides\[0\] >= sides\[1\] ? 0 : 1/sides[0] >= sides[1] ? 1 : 0/ | runtime/check_long_faces
all long faces are cut | runtime/hierarchy/long_faces.c | s/LONG_AREA \* whole/0 * whole/ | runtime/check_long_faces
paths weigh themselves | runtime/engine/reference.c | s/fmax(half\[h\].scattered, alike)/half[h].scattered/ | runtime/check_reference
paths know their scatter | runtime/engine/reference.c | s/(half\[h\].scattered + alike) \/ 2/half[h].scattered/ | runtime/check_reference
weak paths tell, too | runtime/engine/reference.c | s/w < REFERENCE_LEAST/w < 0 * REFERENCE_LEAST/ | runtime/check_reference
paths go on to their noise | runtime/engine/mended_error.c | s/goal->left > 0 \&\& tally/goal->left > 0 \&\& !tally->by_paths \&\& tally/ | runtime/check_path_mending
no link spares a ray | runtime/engine/mended_error.c | s/\*times = fmin(\*times, mended_error_wanted/(void)(mended_error_wanted/ | runtime/check_mended_error
small shades are missed | runtime/engine/sight_cubature.c | s/node->error += missed(l, at);/(void)missed;/ | runtime/check_entries
small shades of solids are missed | runtime/engine/sight_missed.c | s/e->normal) < 0;/e->normal) < INFINITY;/ | runtime/check_entries
parts of polygons count | runtime/engine/exchange_areas.c | s/how->tolerance, scene->input_count,/how->tolerance, tree->h.face_count,/ | runtime/check_entries
faint pairs see all of each other | runtime/engine/sight_rays.c | s/return clear \* share;/return clear;/ | runtime/check_entries
faint pairs see nothing | runtime/engine/sight_rays.c | s/return clear \* share;/return 0 * share;/ | runtime/check_entries
points stand for all | runtime/engine/sight_cubature.c | s/node->unseen = fmax(fabs(/node->unseen = 0 * fmax(fabs(/ | runtime/check_sight_rays
points stand for directions | runtime/engine/sight_rays.c | s/FAR = 4/FAR = 0/ | runtime/check_sight_rays
no one more is lost | runtime/engine/face_error.c | s/noise + 1 \/ (particles \* particles)/noise/ | runtime/check_measured_error
few particles seem normal | runtime/engine/face_error.c | s/count >= FACE_ERROR_MANY/1/ | runtime/check_measured_error
a lone count is sure | runtime/engine/face_error.c | s/fmax(s, c->deviation\[i\]))/s)/ | runtime/check_measured_error
sums of clusters as they come | runtime/engine/mend_clusters.c | s/^        settle_sum(before .*$/        (void)settle_sum;/ | runtime/check_mended_error
all light may be unsure | runtime/engine/mended_error.c | s/\*times = fmax(\*times, for_power);/(void)0;/ | runtime/check_mended_error
a class that none has met is sure | runtime/engine/polygon_counts.c | s/seen\[k\] += more;/seen[k] += 0 * more;/ | runtime/check_measured_error
what is dark is known | solver/output/error_image.c | s/fmax(truth_of(s, seen->error, element), 0)/fmax(truth_of(s, seen->error, element), 1)/ | solver/check_error_image
clusters keep what they were | runtime/hierarchy/children_first.c | s/e = h->built; e-- > 0;/e = 0; e-- > 1;/ | runtime/check_measured_error runtime/check_transport
halves are added | runtime/engine/face_error.c | s/x\[i + step\] = a - b/x[i + step] = a + b/ | runtime/check_measured_error
power says nothing of faces | runtime/engine/face_error.c | s/f->l1.high = fmax(f->l1.high, sure)/(void)sure/ | runtime/check_mended_reach
coarse links that know nothing | runtime/engine/api_choice.c | s/PARTICLE \* spared/0 * spared/ | solver/check_coarse_first
sweeps for nothing | runtime/engine/api_choice.c | s/SWEPT = 0.2/SWEPT = 0/ | runtime/check_choice
links at any price | runtime/engine/api_choice.c | s/may_be_none ? FEW : 0/0 * FEW/ | solver/check_coarse_first runtime/check_choice
scales upon scales | runtime/engine/api_oracle.c | s/near = p->integer ? round(oracle->set\[i\]/near = p->integer ? round(refiner_get(oracle->refiner, i)/; s/: oracle->set\[i\] \* times/: refiner_get(oracle->refiner, i) * times/ | runtime/check_choice
smallest parts grow | runtime/engine/api_oracle.c | s/fmin(scale, 1)/scale/ | runtime/check_choice
a limit met is told | runtime/engine/api_choice.c | s/api_solve(s, limited)/api_solve(s, 0)/ | runtime/check_choice
a tree that was told of light | runtime/hierarchy/hierarchy.c | /^void hierarchy_renew/,/^}/s/element_reset(e);// | runtime/check_clustering
rays of what was given up | runtime/visibility/rays.c | /^void rays_renew/,/^}/s/memset(.*;// | runtime/check_choice
links that nobody keeps | runtime/engine/api_choice.c | s/!x->wishes.keep_links/1/ | runtime/check_choice
light goes through solids | runtime/engine/sight_look.c | s/l->joined && bodies_hold/0 * l->joined \&\& bodies_hold/ | runtime/check_stacked
what is not convex covers nothing | runtime/engine/exchange_contacts.c | s/return told > 0 \&\&/return told < 0 \&\&/ | runtime/check_stacked
what rays take for backs | runtime/engine/exchange.c | s/if (more >= off)/if (0 * more > off)/; s/more <= -off/fabs(more) >= off/ | runtime/check_stacked
what reaches in tells that nothing is solid | runtime/engine/exchange_contacts.c | s/MOST_BACKS = 0.5/MOST_BACKS = 0.75/ | runtime/check_stacked
solids that are none hold nothing | runtime/hierarchy/body_feet.c | s/^ *.. is_over(.*$// | runtime/check_stacked
houses are solid | runtime/hierarchy/body_feet.c | s/lines > 0 ? 0 : 1/1/ | runtime/check_stacked
tubes are solid | runtime/hierarchy/body_feet.c | s/foot->face != NO_FACE ? foot->area : 0/foot->area/; s/return foot->face != NO_FACE \&\&/return/ | runtime/check_stacked
points on the larger face | runtime/engine/exchange_sight.c | s/from_r = apart ?/from_r = 0 * apart ?/ | runtime/check_slots
points inside a quad are no rule | runtime/engine/face_rule.h | s/0.21801733953755267/0.218/ | runtime/check_face_rule
parts with few pieces | runtime/engine/sight_limits.c | s/own.pieces = .*/own.pieces = 8;/ | runtime/check_entries
lines of one half alone | runtime/engine/sight_outlines.c | s/^ *add_seen(c, list, n, list + n, &below)/if (!halved) &/ | runtime/check_outlines
quads bent by more than rays tell | runtime/hierarchy/scene.c | s/SCENE_FLAT_FOR_RAYS \* extent/1e9 * extent/ | runtime/check_reference
pipes cover what they stand on | runtime/hierarchy/body_feet.c | s/return s->lids > 1;/return 0;/ | runtime/check_stacked
pieces cut in the middle | runtime/engine/sight_parts.c | s/OFF_MIDDLE = 0.125/OFF_MIDDLE = 0/ | runtime/check_sheets
near faces are not asked | runtime/engine/sight_cubature.c | s/MISJUDGED = 0.25/MISJUDGED = 0/ | runtime/check_sheets
crowded edges have no mates | runtime/hierarchy/mates.c | s/else if (to - from > 2)/else if (to - from > 99)/ | runtime/check_stacked
boxes in corners are open | runtime/hierarchy/body_lids.c | s/if (lids < 2 /if (lids < 9 / | runtime/check_stacked
walls of a corner line what stands there | runtime/hierarchy/body_lining.c | s/l->within = is_within(l->s, &h->elements\[mate\])/l->within = 1/ | runtime/check_assemblies
faces that lie on each other are apart | runtime/hierarchy/body_feet.c | s/return b->feet_count > 0 \&\& dot3/return 0 \&\& b->feet_count \&\& dot3/ | runtime/check_stacked
solids are of whole sides | runtime/hierarchy/bodies.c | s/return find_by_parts(m, h)/return 0 \&\& find_by_parts(m, h)/ | runtime/check_assemblies
edges that are not equal are nobody's | runtime/hierarchy/across.c | s/if (!(touch->to - touch->from > s->near))/if (!(touch->to - touch->from > s->length - s->near))/ | runtime/check_assemblies
lids patch sides | runtime/hierarchy/bodies.c | s/!is_patched(s) \&\& is_convex/!(0 \&\& is_patched(s)) \&\& is_convex/ | runtime/check_assemblies
shares held to nine digits | runtime/hierarchy/bodies.h | s/BODY_WHOLLY GROUP_GAPS/BODY_WHOLLY 1e-9/ | runtime/check_assemblies
places of equal corners | runtime/hierarchy/mates.c | s/PLACES_APART . h->flat/0/ | runtime/check_bodies
corners that faces round apart are two | runtime/hierarchy/bodies.c | s/PLACES_APART . flat/0 * flat/ | runtime/check_bodies
tiles of equal corners | runtime/hierarchy/group_outline.c | s/PLACES_APART . o->flat/0/ | runtime/check_flat_groups
places parted by one axis | runtime/hierarchy/places.c | s/whole == 3/whole == 1/ | runtime/check_bodies
near faces by the second order | runtime/engine/exchange_clear.c | s/NEAR_DOUBT = 2/NEAR_DOUBT = 0/ | runtime/check_slots
what is far makes all near touch | runtime/engine/exchange_tree.c | s/near \* near < all ?/near * near < 0 * all ?/ | runtime/check_assemblies
oracles' rays as near as shafts | runtime/engine/exchange_tree.c | s/if (!(more > 0))/if (more < 1e9)/ | runtime/check_exchange
covered rows are not looked at again | runtime/engine/exchange.c | s/(!(covered > 0) ../(!(covered > 0) \&\&/ | runtime/check_assemblies
a corner beyond is between | runtime/hierarchy/flat_hull.c | s/!(across(hull\[count - 2\], hull\[count - 1\], p) > 0)/!turns(hull[count - 2], hull[count - 1], p)/ | runtime/check_flat_groups
contacts of parts for wholes | runtime/engine/solve_contact.c | s/element >= c->first && !h->elements\[element\].children/element >= c->first/ | runtime/check_choice
emitters of one leaf | runtime/engine/detail.c | s/return e->vertices \&\& /return e->vertices \&\& !(s->problem.exitance[e->face * s->problem.bands] > 0) \&\& / | runtime/check_ambient
corners below what is emitted | runtime/engine/linear_solution.c | s/x->means->value\[at\] - emitted/x->means->value[at] - 0 * emitted/ | runtime/check_measured_error
edges of solids in large leaves | runtime/engine/covered_leaves.c | s/is_edge \&\& e->area > most/is_edge \&\& e->area > 64 * most/ | runtime/check_covered_leaves
large neighbours of small leaves | runtime/engine/covered_leaves.c | s/depth + 1 >= e.depth/depth + 3 >= e.depth/ | runtime/check_covered_leaves
floors that nothing stands on | runtime/hierarchy/sides.c | s/if (over > -slight)/if (over > 1e9)/ | runtime/check_dark_sides
rims that light does not pass | runtime/hierarchy/sides.c | s/i < count \&\& !failed; i++) {/i < count \&\& count > 1 \&\& !failed; i++) {/ | runtime/check_dark_sides
walks that end where something stands | runtime/visibility/dark_sides.c | s/!s->sides.touched\[side\]/s->sides.far > 0/ | runtime/check_dark_sides
dark sides in the tree | runtime/hierarchy/hierarchy.c | s/dark += faces\[i\].light == FACE_DARK/dark += faces[i].light > FACE_ALONE/ | runtime/check_dark_sides
dark fronts that shade | runtime/hierarchy/hierarchy.h | s/? !f->back : f->light == FACE_ALONE/? !f->back : !f->back/ | runtime/check_dark_sides
leaves of one size | runtime/engine/mend_solution.c | s/rays \* SMALL <= landings/1e9 * SMALL <= landings/ | runtime/check_ambient
ambient light in the dark | runtime/engine/ambient.c | s/area \* (1 - p->reflectance\[at\])/area/ | runtime/check_ambient
backs of another face | runtime/particles/particles.c | s/tally->back\[ray_meets_back(met)\]/tally->back[0]/ | runtime/check_backs
backs of a replicate | runtime/engine/black_backs.c | s,/ REPLICATES / tally->power,/ tally->power, | runtime/check_backs
names of other faces | runtime/engine/dim_faces.c | s/return faces\[d->face\[i\]\].input/return i + 0 * faces[0].input/ | solver/check_unseen
all faces are kept | runtime/particles/tally.c | s/tally->held = (uint32_t)(mine\[1\] - mine\[0\])/tally->held = h->face_count/ | runtime/check_own_counts
letters of another face | runtime/particles/landing_mail.c | s/.owner = tally->owner\[face\]/.owner = 0/ | runtime/check_own_counts
quarters by their place | runtime/hierarchy/quarters.h | s/ + (number - q->child\[leaf\]);/;/ | runtime/check_own_counts
children of several are not told | runtime/engine/mend_places.c | s/            p->at\[c\] = p->held++;/            (void)c;/ | runtime/check_own_counts
new elements leave their parents as they were | runtime/engine/solve_contact.c | s/face\[count++\] = f;/(void)face;/ | runtime/check_measured_error
leaves before have no quarters | runtime/hierarchy/quarters.c | s/q->place\[i\] = made\[.*/q->place[i] = 0;/ | runtime/check_own_counts
meshes far away | solver/output/far_away.c | s/return moved;/return 0;/ | solver/check_picture
sums of groups run over | runtime/engine/separable_sums.c | s/            value\[j\] = 0;/            value[j] += 0;/ | runtime/check_separable_links
shadows grow alike | runtime/engine/sight_rims.c | s/c->grow \* (i + 1)/0 * c->grow * (i + 1)/ | runtime/check_bodies
short sides have directions | runtime/engine/sight_casting.c | s/SHORT = 1e-6/SHORT = 0/ | runtime/check_bodies
shadows hide no others | runtime/engine/sight_rims.c | s/beside += s != own/beside += 0 * (s != own)/ | runtime/check_bodies
shadows that meet are taken twice | runtime/engine/sight_rims.c | s/rim->meets\[own\] = rim->beside > 0/rim->meets[own] = 0/ | runtime/check_bodies
shadows are beside too soon | runtime/engine/sight_rims.c | s/APART = 1e-6/APART = -0.2/ | runtime/check_bodies
nothing is seen from within | runtime/engine/sight_casting.c | s/body->foot ? REST_UNTOLD : REST_ALL/REST_ALL/ | runtime/check_bodies
what no point of a group's rule sees | runtime/kernel/constants.h | s/SHADOW_UNSEEN 0.125/SHADOW_UNSEEN 0.0125/ | runtime/check_entries
points of floors are in the planes of what stands there | runtime/engine/sight_casting.c | s/NEARLY = 0.5/NEARLY = 2/ | runtime/check_bodies
low points are told | runtime/engine/sight_rims.c | s/LOW = 10/LOW = 0/ | runtime/check_bodies
open rims are trusted | runtime/engine/sight_rims.c | s/OPEN = 1e-9/OPEN = 1e9/ | runtime/check_bodies
plates are solids | runtime/hierarchy/body_lids.c | s/deepest < -8 \* s->h->flat/deepest <= 0/ | runtime/check_bodies
dents are solid | runtime/hierarchy/bodies.c | s/high <= s->h->flat \&\&/1 \&\&/ | runtime/check_bodies
rows stay off | runtime/kernel/constants.h | s/\(EXCHANGE_OFF\) *3.0$/\1 1e9/ | runtime/check_again
legs are missed | runtime/kernel/constants.h | s/\(SIGHT_MISSED_MANY\) *5$/\1 0/ | runtime/check_again
slabs between rows | runtime/visibility/environment.h | s/{64, 16, 1}/{16, 64, 0}/ | runtime/check_losses
ways in a sector of a ring | runtime/visibility/environment.c | s/TURN = 2.6[0-9]*/TURN = 1/ | runtime/check_losses
again and no wiser | runtime/engine/exchange_again.c | s/scratch, 1, /scratch, 0, / | runtime/check_again
what lids cover is forgotten | runtime/engine/exchange.c | s/way->covered = covered;/(void)0;/ | runtime/check_standing
floors are of columns | runtime/hierarchy/bodies.c | s/return high > h->flat;/return 0 * high > 1;/ | runtime/check_standing
sides have edges within | runtime/hierarchy/bodies.c | s/other < f .. side\[other\] == side\[f\]/other < f/ | runtime/check_standing
outlines lose corners | runtime/engine/sight_outlines.c | s/cell->n > SIGHT_CELL_MOST/cell->n > 9999/ | runtime/check_outlines
pieces lose corners | runtime/engine/sight_pieces.c | s/cell->n > SIGHT_CELL_MOST/cell->n > 9999/ | runtime/check_outlines
bottoms cover nothing | runtime/hierarchy/body_feet.c | s/status = add_cover(s->h, 0, .own, cover, .by)/(void)own/ | runtime/check_losses
any lid is shut | runtime/hierarchy/body_feet.c | s/cover\[0\] >= most .. cover\[1\] >= most/1/ | runtime/check_standing
covers of both sides add up | runtime/hierarchy/body_feet.c | s/cover\[0\] >= most .. cover\[1\] >= most/cover[0] + cover[1] >= most/ | runtime/check_standing
far covers shut | runtime/hierarchy/body_rest.c | s/ .. high > most .. low < -most)/)/ | runtime/check_standing
parts are strangers | runtime/hierarchy/group_hierarchy.c | s/? group_fills(f, e)/? group_tiles(\&b->outliner, f, faces, e)/ | runtime/check_standing
plates have no backs | runtime/engine/sight_bodies.c | s/0, 1};/0, 0};/ | runtime/check_standing
great icosahedra are solid | runtime/hierarchy/solids.c | s/if (w->met\[index\] == AT_HAND)/if (0)/ | runtime/check_bodies
dented balls are solid | runtime/hierarchy/solids.c | s/high > w->rounds/high > 1e9/ | runtime/check_bodies
horizons have one side | runtime/engine/exchange_horizon.c | s/sign = over\[0\] > 0 ? 1 : -1/sign = 1/ | runtime/check_bodies
END
}

if [ "${1-}" = --made ]; then
    cd "$top" && table | while IFS='|' read -r name file change _; do
        file=$(echo $file)
        { new=$(sed "$change" "$file" 2>/dev/null) && [ "$new" != "$(cat "$file")" ]; } || echo "$name: nothing in $file is like it"
    done
    exit
fi

work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
mkdir "$work/tree"
(cd "$top" && tar cf - --exclude=./build --exclude='./build-*' --exclude=./.git .) | tar xf - -C "$work/tree"
cd "$work/tree" || exit 2
unset MAKEFLAGS MFLAGS MAKELEVEL
export DAGC=build/bin/dagc RADIOSITY=build/bin/radiosity
build() { make -j"$(nproc)" WARN= "$@" >"$work/said" 2>&1; }
build commands || { tail -n 5 "$work/said"; exit 2; }

wanted() { # NAME [BEGINNING...]
    [ $# -gt 1 ] || return 0
    for beginning in "${@:2}"; do
        case $1 in "$beginning"*) return 0 ;; esac
    done
    return 1
}

tried=0 survived=0
while IFS='|' read -r name file change suites; do
    name=$(echo $name) file=$(echo $file)
    wanted "$name" "$@" || continue
    tried=$((tried + 1))
    verdict=survived
    programs= scripts=
    for suite in $suites; do
        [ -e "tests/$suite.c" ] && programs="$programs build/tests/$suite"
        [ -e "tests/$suite.sh" ] && scripts="$scripts tests/$suite.sh"
    done
    cp -p "$file" "$work/kept" && sed -i "$change" "$file"
    if cmp -s "$file" "$work/kept"; then
        verdict="NOT MADE: nothing in $file is like it"
    elif ! build commands $programs; then
        verdict="NOT BUILT: $(grep -m 1 " error: " "$work/said")"
    else
        for program in $programs $scripts; do
            if ! "$program" >"$work/said" 2>&1; then
                verdict="killed by $(basename "$program"): $(grep -m 1 -E -e ':[FE]:' -e '^failed: ' "$work/said" | sed 's/.*:[FE]:[^:]*:\([^:]*\):.*/\1/; s/^failed: //')"
                break
            fi
        done
    fi
    cp "$work/kept" "$file" # newer than what was built of the mutation
    case $verdict in killed*) ;; *) survived=$((survived + 1)) ;; esac
    printf '%-26s %s\n' "$name" "$verdict"
done < <(table)
echo "$tried mutations, $survived not killed"
[ "$survived" = 0 ]
