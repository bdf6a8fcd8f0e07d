#include <check.h>
#include <stdio.h>
#include <stdlib.h>
#include "runtime/make_solve.h"
#include "scene/read_scene.h"
#include "engine/face_error.h"
#include "engine/mend.h"
#include "engine/transport.h"
#include "util/clock.h"
static double *pulled(const struct hierarchy *h, const struct tally *t){ size_t n=(size_t)h->count*t->bands; double *p=calloc(n,sizeof *p);
 for(uint32_t e=h->count;e-->0;){ for(uint32_t k=0;k<t->bands;k++){ if(!h->elements[e].children) p[e*t->bands+k]=tally_leaf(t,e,k); if(e) p[h->elements[e].parent*t->bands+k]+=p[e*t->bands+k]; } } return p; }
int main(int c,char**v){
 struct scene scene; const struct scene_options how={0,1}; if(scene_read(&scene,v[1],&how)<0) return 1;
 int64_t refn=atoll(v[2]); int64_t n=atoll(v[3]); int streams=atoi(v[4]);
 struct solve s; struct solve_options o=quick(2); o.tolerance=1e-4;
 struct refiner *r=oracles_open(c>5?v[5]:"clusters",RELEASE_FLAT); oracles_set(r,v+6,c>6?c-6:0);
 const char *cause; double t0=seconds(); if(solve_open(&s,&scene,&o,&cause)<0) return 2; solve_run(&s,r,&cause); double t1=seconds();
 struct tracer t={.hierarchy=&s.hierarchy,.rays=s.problem.rays,.exitance=s.problem.exitance,.reflectance=s.problem.reflectance,.bands=s.problem.bands,.threads=2};
 tracer_open(&t); struct tally ref; tally_open(&ref,&t,999,1); tally_trace(&ref,&t,(uint64_t)refn/16,NULL);
 double t2=seconds();
 double *P=pulled(&s.hierarchy,&ref); uint32_t B=t.bands; const struct hierarchy*h=&s.hierarchy;
 double refl=0,l1=0,pw=0,leafl1=0;
 #define EVAL(H,L1,LEAF,PW) do{ L1=LEAF=PW=refl=0; double *se=calloc(scene.input_count*B,sizeof(double)); for(uint32_t f=0;f<h->face_count;f++){uint32_t e=h->face_element[f]; for(uint32_t k=0;k<B;k++){ double rho=t.reflectance[f*B+k],d=rho*(H[e*B+k]*h->elements[e].area-P[e*B+k]); refl+=rho*P[e*B+k]; se[h->faces[f].input*B+k]+=d; PW+=d;}} for(size_t i=0;i<(size_t)scene.input_count*B;i++) L1+=fabs(se[i]); for(uint32_t e=0;e<h->count;e++) if(!h->elements[e].children) for(uint32_t k=0;k<B;k++){ double rho=t.reflectance[h->elements[e].face*B+k]; LEAF+=fabs(rho*(H[e*B+k]*h->elements[e].area-P[e*B+k])); } L1/=refl;LEAF/=refl;PW/=refl; free(se);}while(0)
 EVAL(s.state.irradiance,l1,leafl1,pw);
 printf("%s: solve %.2f s, rays %.3g, links %.3g pairs %.3g, leaves %u; ref %.2f s %.3g rays (%.3g rays/s); true power %+.4f l1 %.4f leaf %.4f\n",v[1],t1-t0,(double)rays_count(s.problem.rays).rays,(double)s.refinement.link_count,(double)s.refinement.pairs,h->count,t2-t1,(double)ref.rays,(double)ref.rays/(t2-t1),pw,l1,leafl1);
 int in1=0,inp=0; double ml=0,mh=0,mv=0,ms=0,ml1=0,mleaf=0,mpw=0,al1=0,aleaf=0; double sp=0; int hi=0,lo=0,in2=0,lo2=0,hi2=0; double v2=0,vh2=0;
 for(int i=0;i<streams;i++){ struct tally y; tally_open(&y,&t,(uint64_t)i,1); tally_trace(&y,&t,(uint64_t)n/16,NULL);
  struct face_error f; face_error_open(&f,&s.problem,h,s.state.irradiance,&y);
  in1+= f.l1.low<=l1&&l1<=f.l1.high; lo+=l1<f.l1.low; hi+=l1>f.l1.high; inp+= f.power.low<=pw&&pw<=f.power.high; mv+=f.l1.value/streams; ml+=f.l1.low/streams; mh+=f.l1.high/streams; sp+=(f.power.high-f.power.low)/2/streams; ms+=(f.l1.value-l1)*(f.l1.value-l1)/streams;
  face_error_close(&f);
  size_t nv=(size_t)h->count*B; double *H=malloc(nv*sizeof *H); memcpy(H,s.state.irradiance,nv*sizeof *H); mend_irradiance(&s.operator,&y,H); double a,b,dp; EVAL(H,a,b,dp); ml1+=a/streams; mleaf+=b/streams; mpw+=fabs(dp)/streams;
  struct tally z; tally_open(&z,&t,(uint64_t)i+5000,0); tally_trace(&z,&t,(uint64_t)(n/(getenv("M")?atoi(getenv("M")):1))/16,NULL); face_error_open(&f,&s.problem,h,H,&z); in2+= f.l1.low<=a&&a<=f.l1.high; lo2+=a<f.l1.low; hi2+=a>f.l1.high; v2+=f.l1.value/streams; vh2+=f.l1.high/streams; face_error_close(&f); tally_close(&z);
  double *Q=pulled(h,&y); for(uint32_t e=0;e<h->count;e++) for(uint32_t k=0;k<B;k++) H[e*B+k]=Q[e*B+k]/h->elements[e].area; EVAL(H,a,b,dp); al1+=a/streams; aleaf+=b/streams; free(Q); free(H); tally_close(&y);}
 printf("  n %lld: l1 measured %.4f (%.4f to %.4f) rms off %.4f, cover l1 %d/%d (low>%d high<%d) power %d/%d +-%.4f; mended l1 %.4f leaf %.4f |power| %.4f; particles alone l1 %.4f leaf %.4f; left measured %.4f high %.4f cover %d (%d %d)\n",(long long)n,mv,ml,mh,sqrt(ms),in1,streams,lo,hi,inp,streams,sp,ml1,mleaf,mpw,al1,aleaf,v2,vh2,in2,lo2,hi2);
 return 0; }
