// The number of the surface that is drawn (MaskPlan::of_instance in src/engine/plan/mask_plan.h).
uniform uint surface_number_of_draw;
