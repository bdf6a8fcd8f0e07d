/* constants.h - every threshold that decides an answer: its value, unit, and reason.
 *
 * One home for each, and this is the page that lists them. The reason is a source, a derivation, or
 * the command that measured it; "chosen" says that there is none yet. What merely bounds work
 * (buffers, chunks of a loop) stays where it is used. Headers of tools and terms may use these:
 * dagc --standalone copies the ones that a graph reaches.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_CONSTANTS_H
#define KERNEL_CONSTANTS_H

/* ---- geometry of a pair (kernel, terms, tools) */

/* What dagc --standalone writes holds some of these and is read by C++ compilers, too, which need
 * not know hexadecimal floats: hence quotients. */

/* of the sum of both radii. Corners no farther from a plane lie in it, besides host.flat. Chosen:
 * 256 roundings of floats */
#define PLANE_FLAT (1 / 65536.0)
/* of the way from a corner to the centre. F at a corner is taken so far within, for where two
 * elements touch it has no value at the corner itself. Chosen: a float's rounding is 2^-24 */
#define CORNER_INSET (1 / 1048576.0)
/* of the largest distance. What rounding does to a distance: 512 roundings, more than the sums
 * that lead to it have */
#define DISTANCE_ROUNDING (1 / 17592186044416.0) /* 2^-44 */

/* of the pair's size. Corners no farther from the plane lie in it, and corners so near are one.
 * Chosen: 2^13 roundings, of which a direction between such corners would be made */
#define COSINE_BOUND_FLAT (1 / 1099511627776.0) /* 2^-40 */
/* relative, of a distance's square. A step that wins less is the last. The bound holds after any */
#define COSINE_BOUND_ENOUGH 1e-9
#define COSINE_BOUND_ROUNDING 1e-12 /* of a cosine. Above the rounding of the sums before */
/* radians. A cluster's cone leaves out so much as rounding: acos(1 - CONE_EQUAL) = 1.4e-7 */
#define COSINE_BOUND_CONE 2e-7

/* radii of the smaller polygon. Farther off than NEAR a rule of six points is enough, than MIDDLE
 * of three, than FAR of one: each keeps the relative error near 1e-5
 * (tests/runtime/check_form_factor.c) */
#define POLYGON_FACTOR_NEAR 3.0
#define POLYGON_FACTOR_MIDDLE 8.0
#define POLYGON_FACTOR_FAR 60.0
/* the same at the exact level: nearer, contours are integrated; beyond, they would lose digits and
 * points are better */
#define POLYGON_FACTOR_EXACT 60.0
/* F both ways. Less may be rounding's alone, and is 0 when nothing rises above the other's plane */
#define POLYGON_FACTOR_FAINT 1e-6
/* square of a sine. A normal turned less to its longest edge is so by rounding: that of the
 * narrowest polygon there is (SCENE_THIN) is turned by 1e-9 */
#define POLYGON_FACTOR_TILT 1e-16
/* of the coordinates. What rounding leaves of a corner's height: 16 roundings */
#define POLYGON_FACTOR_FLAT (1 / 562949953421312.0) /* 2^-49 */

/* of F, by one pair of edges. What levels polygon and contour aim at: a hundredth of the errors
 * that they promise, for edges are many (tests/runtime/check_closed_forms.c) */
#define CONTOUR_FACTOR_FAIR 1e-7
#define CONTOUR_FACTOR_EXACT 1e-11
/* of a unit length. What rounding leaves of an integral of ln; to aim lower would not end */
#define CONTOUR_FACTOR_ROUNDING 2e-15
/* cosine of two edges. At less they count as perpendicular and bring nothing: a rounding */
#define CONTOUR_FACTOR_PERPENDICULAR 1e-16
/* square of a sine. Edges at no more are parallel, whose integral is closed: 1000 roundings of a
 * sine */
#define CONTOUR_FACTOR_PARALLEL 1e-26

/* pixels of a side of the hemicube's top; even. Cohen and Greenberg 1985 use 50 to 200. At 128
 * pixels take little from what one point is off by: 9.9 % of the exchange instead of 9.0 % over the
 * links of the room in examples/scenes (radiosity study form-factors) */
#define FORM_FACTOR_PIXELS 128
/* rays of either kind; a power of two. chosen: F is off by 2 % over pairs near and far, by a
 * twentieth of what one point is (tests/runtime/check_form_factor_levels.c) */
#define FORM_FACTOR_RAYS_EACH 256

/* of F, and absolute. The bound of F over a receiver is widened so far, for the rounding of sums
 * over edges */
#define FORM_FACTOR_RANGE_ROUNDING 1e-12
#define FORM_FACTOR_RANGE_LEAST 4e-15

/* of host.ray_offset. `grow` of shaft.h: 32 times what the coordinates lose in single precision */
#define SHAFT_GROW 0.25
/* of host.ray_offset. A quad bent by more is taken for two triangles: an eighth of SHAFT_GROW */
#define SHAFT_BENT 0.03125
/* of host.ray_offset. `margin` of pairs of whole faces, and how much of it the deepest lose */
#define SHAFT_MARGIN 0.5
#define SHAFT_MARGIN_FALL 0.25
/* of host.ray_offset. Heights that differ by less, twice or three times, are rounding. Chosen:
 * far below `grow`, above the rounding of doubles */
#define SHAFT_SLACK (1 / 65536.0)
/* of host.ray_offset. Ends that reach no farther behind a face do so by rounding of the scene's
 * corners, which files hold to 7 digits, and by less than rays start off; chosen */
#define SHAFT_STRIP 0.25
/* of that: the ends reach at least so far before the face; chosen */
#define SHAFT_AWAY 64
/* square of a sine. An end turned less to a face lies flat on it: 2^-10, 0.06 degrees; chosen */
#define SHAFT_PARALLEL (1 / 1048576.0)
/* square of a sine. A corner nearer to the line of an edge makes no plane with it; chosen: its
 * normal has nine digits left */
#define SHAFT_LINE 1e-14

/* of A_r F_rs, per area. Triangles whose two rules differ by less are not halved: a fifth of the
 * error that the header promises */
#define VISIBLE_PART_ERROR 2e-7
/* of the smaller radius. A cell that rises no higher over a plane is not cut by it; chosen */
#define VISIBLE_PART_NEAR 1e-9
/* square of a sine. As SHAFT_LINE, but a plane left out only costs halving */
#define VISIBLE_PART_LINE 1e-20
/* of A_r F_rs. No more than that hidden, or seen, is none; chosen, below VISIBLE_PART_ERROR */
#define VISIBLE_PART_NONE 1e-9

/* of a cell's area. Less of it left is nothing, less of it gone is nothing; chosen */
#define OUTLINE_LEAST (1 / 65536.0)
/* of the eye's height over the plane. Of a face only what is lower casts a shadow, which would
 * have no end; chosen */
#define OUTLINE_BELOW_EYE 1e-6

/* square of a diagonal. Opposite sides that differ by less are equal; chosen: 1e-6 of a length */
#define SAMPLER_PARALLELOGRAM 1e-12
/* segments. Where one ray stands for a pair it is chosen from so many; chosen: what is missed of
 * the weights that way is what four rays miss of them */
#define VISIBILITY_CHOICE 4
/* choices per segment. Then fewer segments than were asked for must do; chosen */
#define CLUSTER_TRIES 8
/* of r R / d^2 times A B / (pi d^2). The irradiance that links of groups misplace, for the kernel
 * is taken for a product; above all of 2,640 pairs of bodies of like size, at most .2, half of them
 * below .003, and 97 of 100 where one is a speck, which on the other's horizon leaves
 * 2.5e-3 (r + R) / d: THOROUGH=1 build/tests/runtime/check_separable_links */
#define SEPARABLE_ERROR 0.25
/* sums of radii. Nearer clusters are not points: there (d - a)^-2 exceeds (d + a)^-2 by 25 times;
 * chosen */
#define CLUSTER_GAP_APART 1.5
/* of the distance of the centres. A blocker is no nearer to the source, so that its umbra is
 * finite; chosen */
#define FEATURE_SIZE_NEAREST (1 / 1048576.0)
/* times. Where a shadow's edge crosses, the emitter's spread may count so much more than its mean
 * says, for both vary together; chosen */
#define POWER_GAP_ALIGNED 16.0
/* of F + dF. What visibility may be wrong by when all of a few rays agree; the Stanford radiosity
 * program in SPLASH-3 */
#define BFV_ERROR_DOUBT 0.1

/* ---- scenes (hierarchy) */

/* m. A scene less wide is refused. Rays' directions are scaled as the scene is, and Embree takes
 * none longer than 1.8e18 (2 / 1e-17 is less); what is a hundredth of a proton wide has mistaken
 * its unit */
#define SCENE_LEAST 1e-17
/* m. A scene wider is refused: Embree takes no distance beyond 1.8e18, and misses faces from a
 * tenth of that on; what is a light year wide has mistaken its unit, too */
#define SCENE_MOST 1e16
/* Coordinates are off by at most their relative rounding times the largest of them. */
/* relative. Rounding of a float: half a unit in its last place [IEEE 754] */
#define SCENE_SINGLE 0x1p-24
#define SCENE_DOUBLE 0x1p-53 /* relative. The same of a double */
/* of a quad's size. Corners no farther from its mean plane make it flat, else it is two
 * triangles. Chosen */
#define SCENE_FLAT_QUAD 1e-4
/* of the scene's extent. They must be no farther either: rays keep 2^-18 of the extent off
 * surfaces, four times that, so that none meets the quad it leaves */
#define SCENE_FLAT_FOR_RAYS 0x1p-20
/* of its longest diagonal. A polygon no wider than that has no area. Chosen: far above the
 * rounding of its area */
#define SCENE_THIN 1e-7
/* roundings of its largest coordinate. The same: of two corners, each may be off by one */
#define SCENE_THIN_ROUNDINGS 2
/* units in the last place of a polygon's largest coordinate. What is no farther from a line through
 * two of its corners is on the line: a difference of two coordinates and a cross product round five
 * times, and the corners themselves were rounded from decimals, once each of the three */
#define POLYGON_ON_LINE 8
/* of its area. A polygon of which ear clipping loses more than that crosses itself; less is what
 * corners rounded to a millionth of it do. Chosen: far above the rounding of the sums */
#define POLYGON_LOST 1e-6
/* of the size of a polygon whose outline crosses itself. Heights and edges no farther apart are
 * one: far above what a crossing's place loses in rounding, far below what coordinates tell. Chosen
 */
#define CROSSING_TOUCH 1e-12

/* Faces cut where others stand (hierarchy/cut_faces.c); `size` is the longest diagonal of the
 * face that is cut. */
/* of the size. Nearer than that to a plane is in it, and lengths that differ by less are equal;
 * what is nearer to a face stands on it (pictures).
 * Chosen: modellers leave gaps of a tenth of a millimetre in rooms of metres */
#define CUT_TOUCH 1e-4
/* roundings of the largest coordinate. The same: both faces may be off, each by two corners */
#define CUT_TOUCH_ROUNDINGS 4
/* radians, and of the size. Lines that near to each other are one. As CUT_TOUCH */
#define CUT_SAME_LINE 1e-4
#define CUT_SLIVER 1e-4 /* of the size. No cut leaves less than that on a side. As CUT_TOUCH */
/* of the size. A cut that near to a corner goes through it, so that no edge is shorter. Chosen,
 * below CUT_SLIVER */
#define CUT_CORNER 1e-5
/* sine. Planes at a smaller angle have no line of contact to speak of. Chosen */
#define CUT_PARALLEL 0.01
/* of a chord. Contacts that cover less of it do not cut: a wall with a door does, the leg of a
 * table does not. Chosen */
#define CUT_COVER 0.5

/* of an area, and of a length. Faces that cover less of the smaller of them do not overlap
 * (hierarchy/overlaps.c): so a face with ten such neighbours takes a thousandth of light too much,
 * which is what a gain may be. Derived from that */
#define OVERLAP_LEAST 1e-4

/* Six times its volume, of twice its area to the power 3/2: a shell that holds less holds nothing
 * and has no inside (hierarchy/shells.c). Chosen: a cube has .068, a sheet of paper 1e-5 */
#define SHELL_THIN 1e-9
/* of the area of a piece that is not closed. If no more is on the one side, that looks turned.
 * Chosen: such pieces may well be folded */
#define SHELL_FEW 0.25

/* faces. The default tree of fewer is of halves, in the file's order where slices of the scene are
 * empty, of more by the surface-area heuristic; chosen. Graphs link clusters of either */
#define CLUSTERS_FACES 1000
/* of a cluster's area: a mean normal no longer than that, times area, points nowhere; rounding
 * of a sum */
#define CONE_LEAST 1e-9
/* of a cosine: normals no farther apart count as equal, so that flat clusters have a cone of
 * angle 0; what rounding leaves of two unit vectors' product */
#define CONE_EQUAL 1e-14
/* between the normals of a coplanar group's faces, least: 0.26 degrees. chosen; heights decide
 * before it */
#define GROUP_COSINE 0.99999
/* of a unit normal: neighbours in the order of one coordinate that are farther apart are not in
 * one plane; chosen, above the rounding of corners given as floats */
#define GROUP_NORMAL_GAP 5e-5
/* of host.flat: the same of heights; half, since a corner may be off either way */
#define GROUP_HEIGHT_GAP 0.5
/* the same at first: heights of small faces, whose rounded corners turn their normals, scatter so
 * far. On a turned cube of 3,072 triangles with corners of 7 digits */
#define GROUP_WIDE_GAP 2.0
/* of a group's outline: so much may its faces' areas be off and still tile it; chosen, above
 * what GROUP_COSINE and rounding of corners make of areas */
#define GROUP_GAPS 1e-5
/* of the scene's size: middles of faces no farther apart are in one row, which is not cut;
 * chosen */
#define GROUP_SAME_PLACE 1e-6
/* faces of a lowest group. Shadows are found group by group: 16 are as good as 8 or 32, by the
 * seconds of `radiosity viewfactors` on rooms of make_room.h */
#define LOWEST_GROUP 16

/* ---- visibility */

/* of the scene's size. Rays start so far off their surface: 32 units in the last place of a
 * float of that size, which Embree's rounding does not cross */
#define RAY_OFFSET 0x1p-18
/* of the ray offset: a point this near to a plane lies in it, so that no ray that starts off the
 * one surface starts behind the other; chosen */
#define RAY_FLAT 0.5
/* cosine. A particle's ray that leaves flatter starts straight above its point, not where the ray
 * from the surface is off by the offset: so far away something may stand in between. Chosen: one
 * ray in 256 is flatter */
#define SLIDE_LEAST 0.0625
/* steps for each face, all together. A million faces are then asked in seconds. Chosen: rooms take
 * up to 10, a ball of 20,000 triangles takes 560: part of a ball so fine counts as in the way */
#define FREE_SPACE_STEPS 256
#define CONTACT_RAYS 8 /* rays per point. chosen: cosine-spread, enough that two may go astray */
/* of CONTACT_RAYS that must meet backs for a point to lie inside a solid. chosen: two may meet
 * fronts of what reaches into the solid; points outside meet backs of closed solids never */
#define CONTACT_BACKS 6
/* of a surface's radius: what hangs higher above it than this, open below, does not stand on a part
 * of it. Chosen; it is a cell and a half of the 4 x 4 points that are asked */
#define STANDING_GAP 0.5
/* of the rays from a point: when so many meet backs, it lies inside a solid. As CONTACT_BACKS of
 * CONTACT_RAYS */
#define ENVIRONMENT_BACKS 0.75
/* of the steps of all walks: so many may end and the scene still counts as closed, for rounding
 * lets a ray through a crack between faces now and then. What can be missed is an opening of
 * that share of all area; one of 1e-4 is found with a probability of 99.99 %
 * (visibility/enclosure.c) */
#define ENCLOSURE_CRACKS 2e-5

/* ---- links and transport (engine) */

/* relative. What an oracle sees of radiosity, spread and importance lags this far behind the
 * truth, so that passes end; chosen, below the 5 % that the oracles' own thresholds decide by */
#define HYSTERESIS 0.02
/* share. The same of deviations, which are bounds: that a bound grew by less is no reason to ask
 * again. Passes over soda fall from 9 to 7 with it; chosen */
#define DEVIATION_HYSTERESIS 0.25
/* relative L1 error of B that iteration may leave, least, when nobody says: links hold V in steps
 * of 2^-14, so that their own rounding is half of it. derived from LINK_VISIBLE */
#define SOLVE_TOLERANCE 1e-4
/* the same at the most. Constants' errors partly cancel, what iteration leaves is all missing: to
 * this, 5e-5 to 4e-4 of the reflected light is (cornell, room, panels, furnace, maze_8, each over
 * its last links) */
#define SOLVE_TOLERANCE_MOST 1e-3
/* extrapolation.h: ratios of changes above which sweeps are slow; how far two may be apart, as a
 * share of what they lack of 1; sweeps in a row. Chosen: below .9 a digit takes 22 sweeps at the
 * most */
#define EXTRAPOLATION_SLOW 0.9
#define EXTRAPOLATION_NEAR 0.3
#define EXTRAPOLATION_STEADY 4
/* sweeps. A bound that has not fallen for so long is as low as rounding lets it be; chosen: without
 * rounding it falls with each */
#define SOLVE_STALLED 64
/* 2^-23, relative. What single precision resolves */
#define SOLVE_SINGLE 1.2e-7
/* the same of double precision, of sums of thousands: 2^6 of its steps of 2^-52 */
#define SOLVE_DOUBLE 1.4e-14
/* of what constants on leaves leave (engine/variation.c): so much iteration may leave beside it.
 * chosen: a tenth is little beside the whole */
#define SOLVE_SHARE 0.1
/* relative L1 error of B. Where groups are linked, passes before the last ones solve to this: a
 * quarter of HYSTERESIS, so that oracles do not notice; must stay below it */
#define ROUGH_TOLERANCE 0.005
/* links per changed link. Passes solve to the tolerance once no more links change than one in
 * this many, and with linear elements passes end; chosen: so few cannot bring many others to
 * change. The last that soda so leaves changing carry 2.5e-3 of its light */
#define SETTLED 1000
/* of 1 - rho: how far the cap may exceed 1 where a face's mean row does. Below 1 the iteration
 * converges, rho (1 + (1 - rho)) < 1; half of it leaves it a rate. derived in row_sums.c */
#define ROW_EXCESS 0.5
/* of the cap. Leaves whose row is below this take nothing of what is capped off others: their
 * row is small because something stands before them, not by error; chosen */
#define ROW_SHADOW 0.5
/* of the largest importance. What oracles see is no less, so that nothing divides by 0; chosen,
 * far below what a picture of 8 bits shows */
#define IMPORTANCE_LEAST 1e-4
/* factor by which an error tolerance falls per pass; Bekaert and Willems 1996 */
#define ERROR_STEP 1.4
/* of the error to be held: the most that all links of a leaf may bring together by the oracle's
 * own measure before the leaf is given up; chosen */
#define ERROR_ENOUGH 0.25
/* of what is between lower and upper solution. A sweep that brings them no nearer than by this is
 * the last of a pass; every further one would bring the largest reflectance of it. chosen */
#define BRACKET_ENOUGH 1e-3
/* cosine. A side whose mean normal is turned less than this to the other side is seen on edge:
 * that normal says nothing of what passes, only the place does; chosen */
#define PIVOT_RELIABLE 0.3

/* ---- measured error (engine) */

/* of the area of all that reflects. A polygon above is a large face to a reader of the summary,
 * however dim, and judged by its own light; chosen: there can be a hundred of them at most */
#define FACE_ERROR_LARGE 0.01
/* standard errors. A large face is surely wrong beyond this: 97.5 % of Student's t with 15 degrees
 * of freedom for the worst of a hundred */
#define FACE_ERROR_SURE 4.44
/* standard errors. An error so far out is what it is seen as: noise neither hides it nor makes it
 * in a thousand polygons */
#define FACE_ERROR_CERTAIN 5.0
/* power of |e^| / s. The most uneven that errors below noise are thought to be: cubes, whose
 * largest tenth has nine tenths of the sum when |e^| is normal; chosen */
#define FACE_ERROR_SHAPE 3.0
/* particles. Where a polygon is met by so many, what its replicates say of its noise has half the
 * weight that it has where many land: their own variance is then twice as uncertain */
#define FACE_ERROR_FEW 16.0
/* particles. Of so many on a polygon, and more, what halves of the replicates have the one less the
 * other is as large in the mean as what all are off: to 1.3 % */
#define FACE_ERROR_MANY 4.0
/* polygons. A class of so many tells by its own replicates half of what noise adds to moduli: as
 * uncertain by then as a hundredth of it; chosen */
#define FACE_ERROR_ALIKE 100.0
/* of the moduli of noise. What is not known of them where fewer than four particles come: a count
 * of one in the mean is off by .74, a normal number of its deviation by .80, and what half of the
 * replicates have less the others by .67 */
#define FACE_ERROR_FEWEST 0.1
/* standard errors. How far a solution may draw the mean that chance is computed from: 95 % */
#define FACE_ERROR_DRAWN 2.0
/* of an element's own squares against those that its class expects: 1 is James and Stein's rule for
 * each alone, 0 one factor for all of a class. Of 0, 1/4, 1/2 and 1 the best for leaves on four
 * scenes of very different kind at 30,000 and 300,000 particles, between 0 and 1/2 by little */
#define MEND_OWN 0.25
/* elements. A class counts as so many against the elements of its level that have a parent's parent
 * in common: as much as MEND_OWN gives to one. Between 3 and 30 cells of five scenes differ by a
 * hundredth (tests/tables/judge.sh) */
#define MEND_KIN (1 / MEND_OWN - 1)
/* standard deviations. How far the squares of a class must be above noise before its links are
 * mended, 2: one class in forty is by chance */
#define MEND_EVIDENCE 2.0
/* the same for one element: what is so far out is believed whatever its class says; 3, as is usual
 * for outliers */
#define MEND_OUTLIER 3.0
/* particles. Leaves on which more are to land are quartered for them. Chosen: on a quarter of so
 * few, chance says more than they do, so finer leaves would show nothing. Cells of corridor, whose
 * faces are long, are off by 8.7 % with 256, by 4.8 with 64 and by 3.5 with 16:
 * tests/tables/judge.sh */
#define MEND_DETAIL 16.0
/* of the fewest rays of mending: leaves are made for so many landings at the least, as it shows
 * only later how many rays are cast. Chosen: two doublings */
#define DETAIL_LANDINGS 4.0
/* of what is reflected. Quarters whose light is nearer than that to their parent's linear
 * function say nothing: chosen, a quarter of a step of pictures of 8 bits and a sixtieth of what
 * mending aims at on places (RAD_CORRECT_PLACES) */
#define DETAIL_SAYS 1e-3
/* of the scene's area. What links and particles are compared on: the cells that solutions are
 * judged by, tests/tables/cell_error.c */
#define PLACE_SHARE 1e-4
/* leaves that are quartered for particles come to no more than so many, about, however many
 * particles are traced: sixteen on a place, in the mean. With half of them cells of a grid of
 * rooms and of sejour are off by 2.30 % for 2.29 and 3.27 for 3.18, with 2 million by no less */
#define MEND_LEAVES (16 / PLACE_SHARE)
/* of the scene's area. Smaller faces are not cut for being long: those that somebody looks at, as
 * FACE_ERROR_LARGE has it; */
#define LONG_AREA 0.01
/* nor into parts below that: sixteen places */
#define LONG_PART (16 * PLACE_SHARE)
/* lengths over width. What is shorter is not long: chosen, more than walls of rooms have */
#define LONG_RATIO 6.0
/* of the scene's area. Larger leaves that a solid covers in part are quartered: chosen, an eighth
 * of a place's side. Cells of maze_8, whose walls are thinner than two places, were off by 3.5 %
 * with leaves as large as links need them, by 3.2 with twice that side, and by 3.1 with this or
 * with half of it: tests/tables/judge.sh */
#define COVERED_SHARE (PLACE_SHARE / 64)
/* standard errors. Paths from a dim polygon that are farther than this from what particles and
 * links say of it have missed light (once in 370 by chance, which then costs split particles);
 * chosen */
#define DIM_MISSED 3.0
/* of its light. A polygon whose standard error is no more is known: within 1.96 of them, 95 %, it
 * is off by 5 %, which a reader may hold every large face to; */
#define DIM_GOAL 0.0255
/* but of many faces one in twenty is many. Where rays are there for it, none is off by so much, */
#define DIM_OFF 0.05
/* unless so probably [Bonferroni] */
#define DIM_DOUBT 0.05
/* particles on a place as large as large faces: where fewer come paths do not end. They know its
 * light to a sixteenth, and a polygon sees many such places. Chosen; with 100 or 1,000 large faces
 * of maze_8 are as wrong for as many rays */
#define DIM_BELIEVED 256
/* times the rays of a first look by paths. Where particles would take no more, there is none.
 * Chosen: it is an eighth of them then */
#define PATHS_LOOK 8.0
/* standard errors. All light by paths and by particles is no farther apart: 1 in 500 of Student's t
 * with 15 degrees of freedom; chosen */
#define PATHS_AGREE 3.7
/* times cheaper than particles, which tell places within faces as well, paths have to be. Chosen; a
 * look makes them two to four times dearer than they are in the end */
#define PATHS_CHEAPER 2.0
/* of the rays that mending would take without links. So many may be spent on paths from dim
 * polygons, besides what links have spared of these (mend_solution.c) */
#define DIM_RAYS 1.0
/* rays of links, mending and paths. Where these are fewer the rest is for split particles, if paths
 * leave a dim polygon unsure: chosen, half a second */
#define DIM_FEW 1.5e6
/* of that rest. So much at the most goes to paths first, if these are thought to make all sure:
 * where they do not the noise of split particles is larger by a seventh; chosen */
#define DIM_REST 0.25
/* times the standard error. So much less paths aim at then: their variance is known to a tenth, its
 * root to a twentieth, and this is two of these */
#define DIM_MARGIN 1.1
/* of what is left for small polygons, and of the rays of mending. So much at the most is for groups
 * of them, which need not be known one by one; chosen */
#define DIM_GATHERED 0.25
/* rays for paths from small polygons, where mending took fewer and DIM_FEW leaves them: chosen, a
 * tenth of a second */
#define DIM_SMALL 4e5
/* of the mean irradiance. Particles are not split for what is dimmer than that by far: what links
 * say of it may be nothing at all, and all rays would go there */
#define DIM_LEAST 1e-6
/* times. What a particle carries may be so much more or less than what the window wants: chosen, as
 * is usual for weight windows; at 2 copies are made where light has halved */
#define SPLIT_WINDOW 2.0
/* ---- account of error (engine) */

/* of a winding number: so near to a whole one is whole. Chosen: coordinates that have been floats
 * leave cracks of 1e-7 of a length, holes are larger */
#define WINDING_WHOLE 1e-6
/* of the way from a leaf's centre to its corners, where its winding number is asked for: chosen, a
 * leaf belongs to one volume but for such a rim */
#define WINDING_INSET 0.98
/* of a scene's mean irradiance. An emitter that may bring no more than that in doubt is not taken
 * by parts: 0.002 takes half as long again for bounds of 0.55 instead of 0.63 of the reflected
 * light, 0.01 three quarters for 0.76 (radiosity solve cornell.obj --errors=all) */
#define RANGE_DETAIL 0.005
/* of RANGE_DETAIL. Ranges of form factors that differ by less as they come are not narrowed; the
 * same measurement: 0.1 instead of 1 takes a tenth longer, for bounds narrower by a sixteenth */
#define RANGE_FINE 0.3
/* of a range of shares. What lies so far outside is rounding: of a float, twice */
#define RANGE_ROUNDING 0x1p-22
/* of the bound. Bounds are iterated until what iteration may still take off them, or must add, is
 * no more: chosen */
#define BOUND_ENOUGH 0.01
/* of a radiosity: what policies are not improved for, since their weights are floats: 16
 * roundings */
#define BOUND_WEIGHTS 1e-6
/* of a radiosity: what rounding may have done to the sums of its bound; as DISTANCE_ROUNDING */
#define BOUND_ROUNDING 1e-12
/* relative. What iteration may leave of an estimate: chosen, below the digits that are told */
#define ACCOUNT_TOLERANCE 1e-3
/* of F, by the level of a link: what the term's header promises as typical, and as the most */
#define FORM_FACTOR_POLYGON_TYPICAL 1e-5
#define FORM_FACTOR_POLYGON_MOST 4e-4
#define FORM_FACTOR_CONTOUR_MOST 1e-9
/* ---- linear elements (engine) */

/* of the radius. An element has no slope across where its root-mean-square width is less: rounding
 * of its corners would decide it. chosen */
#define LINEAR_THIN 1e-6
/* sums of radii. Cells farther apart than FAR have 2 x 2 points each, than NEAR 3 x 3, nearer ones
 * are quartered. So couplings of elements apart are within 2e-3 of F, slope to slope within 4e-3:
 * tests/runtime/check_linear.c, where FAR below NEAR, 2 x 2 points throughout, fails */
#define LINEAR_NEAR 1.0
#define LINEAR_FAR 1.5
/* of the smaller element's radius: cells of that size that are still near are not quartered. Where
 * elements touch, couplings of a mean are then within 3e-2 of F and slope to slope within .15; at
 * half the size 4e-3 and .02 for five times the work, and solutions of a cube and of rooms are no
 * better (tests/runtime/check_linear.c) */
#define LINEAR_CELL 0.51
/* of 1 - rho: how far the row of a nonnegative kernel may exceed 1 at a corner of a leaf; more, and
 * the slopes of that leaf are made less. Above ROW_EXCESS, by which means may, and at most 1, so
 * that rho times the row is below 1; derived in linear_transport.c */
#define LINEAR_ROW_EXCESS 0.75
/* of what all links between surfaces carry. The weakest, so much together, stay constant: that
 * moves at most four times as much light (linear_links.c), a thousandth, a tenth of the error that
 * rays and shadows leave in the best scenes; of soda it is two thirds of the links */
#define LINEAR_FAINT 2.5e-4
/* times. Sweeps whose change has grown so far over the least before do not converge; chosen: the
 * change of a convergent one may rise in norms that are not its own, by a few times */
#define LINEAR_GROWS 10.0
/* particles. A part of the tree that so many have met is mended by what they measured there, a
 * quarter of its H uncertain: many directions end in many parts. Chosen */
#define POINT_ERROR_MET 16.0

/* times the rays of a point of the first stage, at the most, for one of the second: beyond, the
 * noise that the first has measured is too uncertain to save points by; chosen */
#define SURFACE_ERROR_RAYS 6.0
/* landings of particles. So many make one cell of where light lands; chosen: half of it uncertain
 */
#define ERROR_PLACES_CELL 4
/* rays. Fewer would make no interval: 20 points in the first stage and as many in the second */
#define SURFACE_ERROR_LEAST 4000.0

/* ---- light gathered at points (particles) */

/* radii of the element that a ray meets. Nearer than that the ray goes on: the element is seen as
 * large as it is, and so is what it cannot hold. Derived: at one diameter a square fills .18 of
 * what a point before its middle receives, so that no element counts for more than that */
#define GATHER_NEAR 2.0
/* of the mean B of all surfaces. Elements that reflect more are looked for as lamps are, and a ray
 * that meets one goes on, as so many rays as it weighs: light that is so much more in one place
 * than in others varies in it. Chosen; without it the spot behind the lamps of scenes/panels, which
 * nobody sees, leaks out of elements that reach beyond the lamp, and in td the noise of 256 rays is
 * 10 % for 4 (make picture-table) */
#define GATHER_BRIGHT 4.0
/* rays. As so many a ray goes on at the most; chosen: what one of them finds then weighs less than
 * a ray of the first step */
#define GATHER_AGAIN 64

/* ---- exchange areas (engine) */

/* of a row's sum. The default, and the tolerance that the limits of
 * examples/oracles/viewfactors.dag are made for: chosen */
#define EXCHANGE_TOLERANCE 3e-4
/* what the second order leaves out may be so many times what is estimated: the most by which it
 * was in 30,000 random pairs (exchange_clear.c) */
#define CLEAR_REST 3.0
/* of distance squared: the variance of two faces' points together. Above it they may reach as far
 * as to each other, where neither the second order nor rules of points say anything. No corner of a
 * convex polygon is farther from its middle than the root of 8 variances, as of a needle; two
 * such roots are at most that of 16 of their sum */
#define CLEAR_NEAR (1 / 16.0)
/* radii of the face with the points: nearer faces are not smooth enough along it; chosen, with the
 * estimate's excess in random pairs (clear_points.h), which is the next */
#define CLEAR_POINTS_NEAR 1.5
#define CLEAR_POINTS_REST 5.0
/* How far off their faces points look past others, whose planes they would lie in else: this of
 * host.ray_offset, 2^18 times what coordinates lose by rounding, or so many misfits (misfit.h), but
 * no more than rays are. Chosen; a shade is moved by it as far as it is to how far off its face a
 * blocker is */
#define SIGHT_LIFT 0x1p-16
#define SIGHT_MISFITS 8.0
/* of F. Of smaller entries the tolerance is a share of this, not of themselves; chosen */
#define SIGHT_FLOOR 1e-4
/* polygons. In larger scenes it is a share of so much over the root of the number of faces: errors
 * of a row's entries add up like chance, and are a few times below what is estimated; chosen */
#define SIGHT_FEW_POLYGONS 24
#define SIGHT_FLOOR_MANY 4.0
/* of the tolerance. In small scenes estimates have to be that small: each entry is looked at for
 * itself there, and of 1,600 past one to three plates a few are off by up to four times what is
 * estimated */
#define SIGHT_FEW_SURE 0.25
/* parts of a face. In pieces below that shades are no longer looked for that no point sees: a face
 * that only touches what lies between would have them cut along a line, as far as there are any.
 * Chosen: what is left is a 200th of a side wide */
#define SIGHT_MISSED 1024
/* the same in scenes of many polygons: in the face itself and its quarters, since tables' legs,
 * seen from each other, made rows of 1.008 there; measured: further down it takes twice as long for
 * a third less error */
#define SIGHT_MISSED_MANY 5
/* in scenes of few polygons, of pieces that all points see dark, past two faces or more: light may
 * pass between two shades, and SIGHT_ALIKE of what they would exchange counts as error. Of a random
 * scene of six quads an entry was .55 % off by a thirtieth of a face. Chosen: 1024 takes up to 2.5
 * times as long (panels), 64 up to 1.5 times */
#define SIGHT_DARK 64
/* of what a piece would exchange with nothing between: no more than rounding */
#define SIGHT_ROUNDING 1e-6
/* pieces that a pair in half shadow may be cut into, in small scenes and in others; chosen */
#define SIGHT_PIECES 8192
#define SIGHT_PIECES_MANY 512
/* What the best quadratic leaves of the values at the points of a piece, or what its two rules
 * differ by, if that is more: so much of it is the error of the rule inside, and so much of the
 * former that of its four quarters. Of 20,000 random shades, products and unions of up to three
 * ramps of .05 to 3 sides, on a triangle and a quad: where that is up to half of what may be wrong,
 * of which half of them are, .03 and .05 % are wrong by more (where the two rules differ by a
 * quarter of it alone, .3 and .1 to .8 %); of quarters, .06 % (.3 to .6); without the points that
 * weigh nothing, of quads by products of Gauss points, and .125 of it for quarters. But shades that
 * repeat agree by chance. Of as many on a quad, of waves of .5 to 6 a side, half of them along one,
 * the second half of these with a ramp besides, .005 and .06 % are wrong by more than .01 of what
 * may be exchanged, with quarters (with .125 of it: .01 and .12; of products of Gauss points: .19
 * and .42, with .5 .14 and .22). Among view factors past 2 to 10 fins, 42 scenes, 218 entries were
 * off by more than the tolerance, by up to 6.5 of it, by products and .125; with .5 of it 4, by
 * 1.1, for a fifth more time; by points turned and .25 of it 2, by 1.4; by .3 none, in less time
 * than before, and off by a fifth as much in the mean */
#define SIGHT_REST 0.5
#define SIGHT_REST_QUARTERS 0.3
/* of what a part exchanges with nothing between, in scenes of many polygons: its error, before it
 * is held against its quarters, where all of its 16 to 37 points see the same, all or nothing, and
 * no shaft proves it. Slits between tubes were missed: a row was off by 6e-3; chosen, a tenth of
 * what chance might have hidden from so few */
#define SIGHT_ALIKE 0.01
/* of the tolerance: pieces whose error is that much are believed; see SIGHT_REST */
#define SIGHT_BELIEVED 0.5
/* tolerances: rows that are off by more are looked at again, without rules that are believed;
 * chosen: errors of entries, each up to half a tolerance of itself, do not add up to that by chance
 */
#define EXCHANGE_OFF 3.0
/* of a side: how far within a piece points along its rim stand, so that none is in a corner that
 * touches; chosen */
#define SIGHT_RIM 1e-3
/* of what is exchanged with nothing between, by pieces, where these see anything: what is below
 * that is below the exact one */
#define SIGHT_NEARLY_CLEAR 0.999
/* of a piece's exchange: its error when no pieces are left to hold it against; chosen */
#define SIGHT_UNKNOWN 0.1
/* shares of a pair of groups in half shadow, seen from four points, that may be wrong. Of how much
 * more one point or corner sees than another: where a line parts a face, the points on one side of
 * it stand for at most so much more or less of the face. At the least, for what none of them sees;
 * chosen: a strip of a quarter that fades */
#define SHADOW_BETWEEN 0.31
#define SHADOW_UNSEEN 0.125
/* of a row's sum: what reciprocal closure may leave. chosen: all twelve digits that are written */
#define CLOSURE_ENOUGH 1e-12

/* ---- references (engine) */

/* particles. Where fewer than these are to be expected, how replicates differ does not say how sure
 * they are: their variance then depends on their mean, and weights by it favour what is dark by
 * chance, by a share of the standard error that falls with the root of this: 3 % here; chosen */
#define REFERENCE_FEW 1000
/* of a polygon's light. Where paths would tell less than that, particles tell all: chosen, its
 * standard error is a sixth larger then at the most; weights of rare paths are rarely right */
#define REFERENCE_LEAST 0.25
/* standard errors. Paths that are farther from particles than this have missed light, and weigh as
 * that tells (as two Gaussians are once in twenty); what they claim grows only where they are
 * farther than the second (once in 370), so that it stays what chance makes it; chosen */
#define REFERENCE_DOUBT 2.0
#define REFERENCE_MISSED 3.0
/* of the mean over its standard error, squared: so many paths at the least have found light, and
 * their spread is known to a tenth. Others do not judge whether two methods agree; chosen */
#define REFERENCE_SURE 100

/* ---- pictures and meshes (solver/output) */

/* cosine of one degree: faces turned less are one surface. chosen: flat when shaded */
#define OUTPUT_SAME_PLANE 0.99985
#define OUTPUT_SAME_LINE 0.999998 /* cosine of a tenth of a degree: one direction. chosen */
#define OUTPUT_REACH 4            /* CUT_TOUCHes along a wall and ... */
/* ... up it, where it must be to stand here. chosen: clear of what touches, near enough to be
 * local */
#define OUTPUT_RISE 3
/* rays. A sample of a pixel gathers by one of each kind at the least */
#define GATHERING_LEAST 2
/* rays of all corners' first sets per pixel: a pixel gathers by as many at the least, were it asked
 * to. Chosen */
#define GATHERING_SHARE 8
/* rays by which one corner gathers in its first set, half of them towards what is bright, at the
 * most and at the least; the second has half as many. Chosen; make picture-table tells what comes
 * of it */
#define GATHERING_MOST 256
#define GATHERING_FEWEST 64
/* corners. So many of a face say what gathering is worth on it: known to a
 * third; chosen */
#define GATHERING_TELLING 16
/* of the way from a corner to the centre of the smallest leaf there. Chosen: between 1/64 and 1/2
 * pictures are equally good; what stands at the corner is clear of it */
#define GATHERING_INWARD 0.25
/* of the step from means of leaves to what was gathered, beyond noise, root mean square: by so much
 * leaves are off by chance, the rest is what they are too large for. Chosen: of .3, .6 and 1 the
 * largest by which pictures are no farther off (make picture-table) */
#define GATHERING_LEAVES 0.3
/* squares of noise. What is as large as that, in the mean of a neighbourhood, is taken off. Chosen:
 * by 1 walls are still patchy, by 4 shadows are 1/20 farther off */
#define SMOOTHING_THRESHOLD 2.0
/* where the log-mean of a picture goes. chosen: 0.18 is a film's middle grey, rooms with bright
 * walls want more */
#define EXPOSURE_MIDDLE 0.34
/* share of a picture that is darker than what the shoulder is measured by. chosen: lamps and
 * highlights are less */
#define EXPOSURE_BRIGHT 0.98

/* ---- where refinement ends that would not end by itself (engine/limits.c) */

/* splits below a face: parts of 2e-10 of it, where default oracles allow 1e-7 of the scene: 11
 * splits. Where two faces meet, parts along the edge double with each split and end in links as
 * fast as they are made, so that no other limit is met for long: bf_guarded with min_share = 0 on
 * cornell has discussed 0.5 M pairs by 17 splits, 1.1 M by 19, and by 21 more than 30 s can hold.
 * On td, whose 1640 faces have other pairs to link first, it is met after 76 M pairs and 21 M
 * links, 140 s of one processor: nothing before tells these from the links of a sound solve.
 * Less than CAN_SPLIT_DEPTH, where guards with limits of 0 link all that they were to split */
#define LIMIT_DEPTH 16
/* elements count their depth in a byte */
#define LIMIT_DEPTH_MOST 250
/* parts of faces ahead of twice the links and stops. chosen: they fit into 0.6 GB, and scenes at
 * hand are never ahead by a hundredth of it */
#define LIMIT_AHEAD 2e6
/* of the memory that is there, for links, and for elements. chosen: the rest is for what is solved
 * over them */
#define LIMIT_MEMORY 0.5
/* discussions: hours. chosen */
#define LIMIT_PAIRS 100000000000
/* of up to 131072 pairs each. chosen */
#define LIMIT_ROUNDS 10000000

#endif
