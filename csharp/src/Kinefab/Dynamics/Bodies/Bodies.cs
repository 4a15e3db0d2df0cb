using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics;

/// <summary>Motions that a body is denied in the world's axes (PxRigidDynamicLockFlag; RigidbodyConstraints >> 1).</summary>
[Flags]
internal enum BodyLocks : byte
{
    None = 0,
    LinearX = 1,
    LinearY = 2,
    LinearZ = 4,
    AngularX = 8,
    AngularY = 16,
    AngularZ = 32,
}

/// <summary>What a body is made of; frame = centre of mass and principal axes.</summary>
internal struct BodyDefinition
{
    public Pose Pose;
    public Vector3d LinearVelocity;
    public Vector3d AngularVelocity;

    /// <summary>kg.</summary>
    public double Mass;

    /// <summary>Principal moments about the centre of mass, kg m^2; 0 stands for infinite, as in PhysX.</summary>
    public Vector3d Inertia;

    /// <summary>1/s.</summary>
    public double LinearDamping;
    public double AngularDamping;

    /// <summary>rad/s.</summary>
    public double MaxAngularSpeed;
    public bool UseGravity;
    public bool IsKinematic;
    public BodyLocks Locks;
    public int PositionIterations;
    public int VelocityIterations;

    /// <summary>A body of 1 kg and 1 kg m^2 with PhysX's defaults, but no angular damping and no speed limit.</summary>
    public static BodyDefinition Default => new()
    {
        Pose = Pose.Identity,
        Mass = 1,
        Inertia = new Vector3d(1, 1, 1),
        MaxAngularSpeed = double.PositiveInfinity,
        UseGravity = true,
        PositionIterations = 6,
        VelocityIterations = 1,
    };
}

/// <summary>The bodies of a world, one array a quantity. Velocities are those of the centre of mass, in the world frame.</summary>
internal sealed class Bodies
{
    public readonly int Count;

    /// <summary>Centre of mass and principal axes in the world.</summary>
    public readonly Pose[] Poses;
    public readonly Vector3d[] LinearVelocities;
    public readonly Vector3d[] AngularVelocities;

    /// <summary>1/kg; 0 for a kinematic body.</summary>
    public readonly double[] InverseMasses;

    /// <summary>Inverse principal moments, 1/(kg m^2), in the body's frame; 0 for a kinematic body.</summary>
    public readonly Vector3d[] InverseInertias;
    public readonly double[] LinearDampings;
    public readonly double[] AngularDampings;
    public readonly double[] MaxAngularSpeeds;
    public readonly bool[] UseGravity;
    public readonly bool[] IsKinematic;

    /// <summary>Where a kinematic body shall be after the next step.</summary>
    public readonly Pose[] KinematicTargets;
    public readonly BodyLocks[] Locks;
    public readonly int[] PositionIterations;
    public readonly int[] VelocityIterations;

    /// <summary>Forces at the centre of mass for the next step, N; cleared by it.</summary>
    public readonly Vector3d[] Forces;

    /// <summary>Torques for the next step, N m; cleared by it.</summary>
    public readonly Vector3d[] Torques;

    public Bodies(ReadOnlySpan<BodyDefinition> definitions)
    {
        Count = definitions.Length;
        Poses = new Pose[Count];
        LinearVelocities = new Vector3d[Count];
        AngularVelocities = new Vector3d[Count];
        InverseMasses = new double[Count];
        InverseInertias = new Vector3d[Count];
        LinearDampings = new double[Count];
        AngularDampings = new double[Count];
        MaxAngularSpeeds = new double[Count];
        UseGravity = new bool[Count];
        IsKinematic = new bool[Count];
        KinematicTargets = new Pose[Count];
        Locks = new BodyLocks[Count];
        PositionIterations = new int[Count];
        VelocityIterations = new int[Count];
        Forces = new Vector3d[Count];
        Torques = new Vector3d[Count];
        for (int i = 0; i < Count; i++)
        {
            Poses[i] = definitions[i].Pose;
            KinematicTargets[i] = definitions[i].Pose;
            LinearVelocities[i] = definitions[i].LinearVelocity;
            AngularVelocities[i] = definitions[i].AngularVelocity;
            Change(i, definitions[i]);
        }
    }

    /// <summary>A body's pose; the identity for Joint.World.</summary>
    public Pose PoseOf(int body) => body < 0 ? Pose.Identity : Poses[body];

    /// <summary>A body's angular velocity, rad/s in the world frame; none for Joint.World.</summary>
    public Vector3d AngularVelocityOf(int body) => body < 0 ? Vector3d.Zero : AngularVelocities[body];

    /// <summary>Translation and rotation, J; a frozen rotation and a kinematic body count for nothing.</summary>
    public double KineticEnergy(int body)
    {
        double inverseMass = InverseMasses[body];
        Vector3d w = Poses[body].Rotation.InverseRotate(AngularVelocities[body]);
        Vector3d inertia = InverseInertias[body];
        double energy = inverseMass > 0 ? LinearVelocities[body].LengthSquared / inverseMass : 0;
        for (int i = 0; i < 3; i++)
        {
            energy += inertia[i] > 0 ? w[i] * w[i] / inertia[i] : 0;
        }

        return energy / 2;
    }

    /// <summary>-m g.x, J; 0 for a body without gravity or mass.</summary>
    public double PotentialEnergy(int body, Vector3d gravity) =>
        UseGravity[body] && InverseMasses[body] > 0 ? -Vector3d.Dot(gravity, Poses[body].Position) / InverseMasses[body] : 0;

    /// <summary>All that a program or a step may change.</summary>
    public void Exchange(StateTape tape)
    {
        tape.Array(Poses);
        tape.Array(LinearVelocities);
        tape.Array(AngularVelocities);
        tape.Array(KinematicTargets);
        tape.Array(Forces);
        tape.Array(Torques);
        tape.Array(InverseMasses);
        tape.Array(InverseInertias);
        tape.Array(LinearDampings);
        tape.Array(AngularDampings);
        tape.Array(MaxAngularSpeeds);
        tape.Array(UseGravity);
        tape.Array(PositionIterations);
        tape.Array(VelocityIterations);
    }

    /// <summary>What a body is made of and how it is solved anew; where it stands and how it moves stays.</summary>
    public void Change(int i, in BodyDefinition d)
    {
        InverseMasses[i] = d.IsKinematic ? 0 : 1 / d.Mass;
        InverseInertias[i] = d.IsKinematic ? Vector3d.Zero : new Vector3d(Inverse(d.Inertia.X), Inverse(d.Inertia.Y), Inverse(d.Inertia.Z));
        LinearDampings[i] = d.LinearDamping;
        AngularDampings[i] = d.AngularDamping;
        MaxAngularSpeeds[i] = d.MaxAngularSpeed;
        UseGravity[i] = d.UseGravity;
        IsKinematic[i] = d.IsKinematic;
        Locks[i] = d.Locks;
        PositionIterations[i] = d.PositionIterations;
        VelocityIterations[i] = d.VelocityIterations;
    }

    private static double Inverse(double moment) => moment > 0 ? 1 / moment : 0;
}
