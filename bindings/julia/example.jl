# Two elastic disks that collide under a force of the host: the scene that the example of every language makes, with the
# same bits. It prints the number of particles, the time and the hash of the state.
include("MPM.jl")
using .MPM
using Printf

# Bends the way of particles: the force is 0.05 x downwards per mass.
function pull(user::Ptr{Cvoid}, batch::Ptr{mpm_particle_batch}, add::Ptr{Float64})::Int32
    b = unsafe_load(batch)
    position = columns(b.position, b.ld, b.dim)
    mass = columns(b.mass, b.ld, 1)
    sum = columns(add, b.ld, b.dim)
    for i in 1:b.n
        sum[i, 2] += mass[i, 1] * (-0.05 * position[i, 1])
    end
    return MPM_OK
end

function disk(context, grid, material, centre, velocity)
    out = Ref{Ptr{mpm_particles}}(C_NULL)
    check(context, mpm_particles_create(context, grid, material, out))
    set = out[]
    check(context, mpm_particles_fill_ball(set, [centre, centre], 0.15, Int32[2, 2], C_NULL, C_NULL))
    check(context, mpm_particles_set_all(set, "velocity", MPM_F64, 2, [velocity, velocity]))
    return set
end

function main()
    services = ready(mpm_context_desc)
    services.isa = MPM_ISA_PORTABLE
    services.concurrency = 2
    services.serial_callbacks = 1
    context_out = Ref{Ptr{mpm_context}}(C_NULL)
    status = mpm_context_create(services, context_out)
    status == MPM_OK || error("no context: $status")
    context = context_out[]

    box = ready(mpm_grid_desc)
    box.dim = 2
    box.cells = (40, 40, 0)
    box.spacing = (0.025, 0.025, 0.0)
    grid_out = Ref{Ptr{mpm_grid}}(C_NULL)
    check(context, mpm_grid_create(context, box, grid_out))
    grid = grid_out[]

    material_out = Ref{Ptr{mpm_material}}(C_NULL)
    names = ["E", "nu", "density"]
    GC.@preserve names begin
        values = mpm_param.(pointer.(names), [1e3, 0.3, 1e3])
        check(context, mpm_material_create(context, "neo_hookean", values, 3, material_out))
    end
    material = material_out[]
    left = disk(context, grid, material, 0.2, 0.5)
    right = disk(context, grid, material, 0.8, -0.5)

    options = ready(mpm_stepper_desc)
    options.scheme = MPM_MUSL
    options.projected_positions = 1
    stepper_out = Ref{Ptr{mpm_stepper}}(C_NULL)
    check(context, mpm_stepper_create(context, grid, options, stepper_out))
    stepper = stepper_out[]
    check(context, mpm_stepper_add(stepper, left))
    check(context, mpm_stepper_add(stepper, right))
    force = @cfunction(pull, Int32, (Ptr{Cvoid}, Ptr{mpm_particle_batch}, Ptr{Float64}))
    check(context, mpm_stepper_set_force(stepper, force, C_NULL))
    for step in 1:400
        check(context, mpm_step(stepper, 2e-3, C_NULL))
    end

    info = ready(mpm_step_info)
    check(context, mpm_stepper_info(stepper, info))
    hash = Ref{UInt64}(0)
    check(context, mpm_state_hash(stepper, hash))
    @printf("particles %d\n", mpm_particles_count(left) + mpm_particles_count(right))
    @printf("time %.6f\nhash %016x\n", info.t, hash[])

    check(context, mpm_stepper_destroy(stepper))
    check(context, mpm_particles_destroy(left))
    check(context, mpm_particles_destroy(right))
    check(context, mpm_material_destroy(material))
    check(context, mpm_grid_destroy(grid))
    mpm_context_destroy(context)
    return nothing
end

main()
