using Kinefab.Document;
using Kinefab.Numerics;

namespace Kinefab.Dynamics;

/// <summary>A Rigidbody in PhysX's terms.</summary>
internal static class RigidbodyModel
{
    // The centre of mass is given in metres along the object's axes, whatever its scale (ScriptReference, Rigidbody.centerOfMass).
    public static Pose MassFrame(Rigidbody body) => new(body.CenterOfMass, body.InertiaTensorRotation.Normalized());

    /// <summary>The body.</summary>
    /// <param name="body">Its component.</param>
    /// <param name="physics">For what the component leaves open.</param>
    /// <param name="pose">Of the GameObject in the world.</param>
    public static BodyDefinition Of(Rigidbody body, Physics physics, in Pose pose)
    {
        RigidbodyConstraints frozen = body.Constraints;
        return new BodyDefinition
        {
            Pose = pose * MassFrame(body),
            Mass = body.Mass,
            Inertia = new Vector3d(
                Frozen(frozen, RigidbodyConstraints.FreezeRotationX) ? 0 : body.InertiaTensor.X,
                Frozen(frozen, RigidbodyConstraints.FreezeRotationY) ? 0 : body.InertiaTensor.Y,
                Frozen(frozen, RigidbodyConstraints.FreezeRotationZ) ? 0 : body.InertiaTensor.Z),
            LinearDamping = body.LinearDamping,
            AngularDamping = body.AngularDamping,
            MaxAngularSpeed = body.MaxAngularVelocity ?? physics.DefaultMaxAngularSpeed,
            UseGravity = body.UseGravity,
            IsKinematic = body.IsKinematic,
            Locks = Locks(frozen),
            PositionIterations = body.SolverIterations ?? physics.SolverIterations,
            VelocityIterations = body.SolverVelocityIterations ?? physics.SolverVelocityIterations,
        };
    }

    // Positions are frozen in the world's axes, by PhysX's locks; rotations by setting the inertia tensor's components to zero, which
    // stands for infinite (ScriptReference, Rigidbody.constraints and Rigidbody.inertiaTensor): about the principal axes, also
    // where inertiaTensorRotation turns these.
    private static BodyLocks Locks(RigidbodyConstraints frozen) =>
        (Frozen(frozen, RigidbodyConstraints.FreezePositionX) ? BodyLocks.LinearX : 0)
        | (Frozen(frozen, RigidbodyConstraints.FreezePositionY) ? BodyLocks.LinearY : 0)
        | (Frozen(frozen, RigidbodyConstraints.FreezePositionZ) ? BodyLocks.LinearZ : 0);

    private static bool Frozen(RigidbodyConstraints constraints, RigidbodyConstraints one) => (constraints & one) != 0;
}
