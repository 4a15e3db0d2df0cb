using System;
using System.Collections.Generic;
using System.Threading;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using Kinefab.Validation;

namespace Kinefab.Advice.Runs;

/// <summary>A scene simulated from its start pose, with everything that findings ask of it.</summary>
internal sealed class SceneRun
{
    // Joints times parts of steps after which a run whose steps are forced is ended: a second or so.
    private const double MostSubstepWork = 1e5;

    private SceneRun(World world, ValidScene scene, RunPlan plan)
    {
        Joints = new JointRecord[world.Joints.Count];
        for (int j = 0; j < Joints.Length; j++)
        {
            WorldJoint joint = world.Joints[j];
            Joints[j] = new JointRecord(joint, scene.Freedoms(joint.GameObject, joint.Component), plan.Samples);
        }

        Centers = new Vector3d[plan.Samples][];
        Rotations = new Quaterniond[plan.Samples][];
    }

    /// <summary>In the world's order.</summary>
    public JointRecord[] Joints { get; }

    /// <summary>Centres of mass by sample and body, world, metres.</summary>
    public Vector3d[][] Centers { get; }

    /// <summary>Rotations of the bodies' objects by sample and body.</summary>
    public Quaterniond[][] Rotations { get; }

    /// <summary>False where the solver could not follow the scene: the run ended there, and nothing it says holds.</summary>
    public bool IsSound => Trouble.Length == 0;

    /// <summary>Why and when it ended early, as the end of a sentence; empty where it did not.</summary>
    public string Trouble { get; private set; } = "";

    /// <summary>Runs a scene under a solver.</summary>
    /// <param name="scene">The scene, changed or not.</param>
    /// <param name="solver">Who moves it.</param>
    /// <param name="plan">When it is looked at.</param>
    /// <param name="substeps">Steps from one look to the next.</param>
    /// <param name="cancellation">Ends the run early, with an OperationCanceledException.</param>
    /// <param name="prepare">Done to the world before its first step.</param>
    public static SceneRun Of(ValidScene scene, SolverKind solver, RunPlan plan, int substeps, CancellationToken cancellation, Action<World>? prepare = null)
    {
        World world = World.Create(scene, solver, cancellation);
        prepare?.Invoke(world);
        var run = new SceneRun(world, scene, plan);
        double dt = plan.Step / substeps;
        for (int k = 0; k < plan.Samples; k++)
        {
            cancellation.ThrowIfCancellationRequested();
            for (int s = 0; s < substeps; s++)
            {
                world.Step(dt);
                run.Note(k >= plan.Samples / 2);
                run.Trouble = TroubleOf(world);
                if (!run.IsSound)
                    return run;
            }

            run.Sample(world.Bodies, k);
        }

        return run;
    }

    private static string TroubleOf(World world)
    {
        string cause = world.Stops > 0
            ? world.Solver == SolverKind.Exact ? "a step has no solution" : "its motion leaves the range of numbers"
            : world.SubstepWork > MostSubstepWork ? "its steps had to be cut again and again" : "";
        return cause.Length == 0 ? "" : $"{cause}, and the run was ended after {AdviceMeasure.Text(world.Time)} s";
    }

    private void Note(bool isLate)
    {
        foreach (JointRecord joint in Joints)
            joint.Note(isLate);
    }

    private void Sample(IReadOnlyList<WorldBody> bodies, int k)
    {
        Centers[k] = new Vector3d[bodies.Count];
        Rotations[k] = new Quaterniond[bodies.Count];
        for (int i = 0; i < bodies.Count; i++)
        {
            Centers[k][i] = bodies[i].CenterOfMass;
            Rotations[k][i] = bodies[i].Pose.Rotation;
        }

        foreach (JointRecord joint in Joints)
            joint.Sample(k);
    }
}
