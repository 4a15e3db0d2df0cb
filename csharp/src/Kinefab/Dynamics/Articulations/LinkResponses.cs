using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Articulations;

/// <summary>
/// What impulses do to an articulation whose joints move freely. Impulses on links are kept with the joints and the root until
/// <see cref="Flush"/>, so that each costs no more than the way to the root, and a velocity no more than the way back.
/// Source: Mirtich, Impulse-based dynamic simulation, 1996, section 4.4; DyFeatherstoneArticulation.cpp, pxcFsApplyImpulse, pxcFsGetVelocity.
/// </summary>
internal sealed class LinkResponses
{
    private const int Axes = ArticulationTree.MostAxes;

    private readonly ArticulationTree _tree;
    private readonly ForwardDynamics _dynamics;

    /// <summary>Change of a link's motion by an impulse at its centre of mass; see <see cref="FindResponses"/>.</summary>
    public readonly SpatialMatrix[] Links;

    /// <summary>From the shared point, which is the root's centre of mass, to the link's.</summary>
    public readonly Vector3d[] Arms;

    /// <summary>Of each freedom its motion, and what a unit of force on it takes from the parent: <see cref="ForwardDynamics.Axis"/> and Reactions.</summary>
    public readonly SharedTwist[] Axis;
    public readonly SharedWrench[] Reactions;

    /// <summary>Change of a link's motion by a unit of impulse on a freedom, and of the speeds of its joint's freedoms.</summary>
    public readonly SharedTwist[] AxisChanges;
    public readonly double[] AxisSpeeds;

    /// <summary>Impulses kept at the freedoms.</summary>
    public readonly double[] Kept;

    /// <summary>Impulse kept at the root.</summary>
    public SharedWrench RootKept;

    private readonly SharedTwist[] _changes;
    private readonly int[] _path;

    public LinkResponses(ArticulationTree tree, ForwardDynamics dynamics)
    {
        _tree = tree;
        _dynamics = dynamics;
        int n = tree.Count;
        int m = tree.Freedoms;
        Links = new SpatialMatrix[n];
        Arms = new Vector3d[n];
        Axis = new SharedTwist[m];
        Reactions = new SharedWrench[m];
        AxisChanges = new SharedTwist[m];
        AxisSpeeds = new double[m * Axes];
        Kept = new double[m];
        _changes = new SharedTwist[n];
        _path = new int[n];
    }

    /// <summary>Change of the root's motion by what is kept.</summary>
    public SharedTwist RootChange => new(_dynamics.RootResponse.Times(RootKept.At(Vector3d.Zero)), Vector3d.Zero);

    /// <summary>Of all links, outwards: L' = (1 - S D^-1 (IS)^T) X L X^T (..)^T + S D^-1 S^T.</summary>
    public void FindResponses()
    {
        Links[0] = _dynamics.RootResponse;
        Span<Twist> seen = stackalloc Twist[Axes];
        for (int i = 1; i < _tree.Count; i++)
        {
            Vector3d arm = _tree.Poses[i].Position - _tree.Poses[0].Position;
            Arms[i] = arm;
            SpatialMatrix response = Links[_tree.Parents[i]].From(_dynamics.Levers[i] * -1);
            int first = _tree.FirstFreedom[i];
            int count = _tree.FirstFreedom[i + 1] - first;
            for (int k = 0; k < count; k++)
            {
                seen[k] = response.Times(_dynamics.Reactions[first + k]);
                Axis[first + k] = new SharedTwist(_dynamics.Axis[first + k], arm);
                Reactions[first + k] = new SharedWrench(_dynamics.Reactions[first + k], arm);
            }

            for (int k = 0; k < count; k++)
            {
                // S_k k_k^T + k_k S_k^T leaves, and S_k S_l^T (D^-1 + R^T L R)_kl comes; half of it in each of two outer products.
                Twist half = seen[k] * -1;
                Twist change = half;
                for (int l = 0; l < count; l++)
                {
                    double share = _dynamics.InverseInertias[i * 9 + 3 * k + l] + Wrench.Dot(_dynamics.Reactions[first + l], seen[k]);
                    AxisSpeeds[(first + k) * Axes + l] = share;
                    half += _dynamics.Axis[first + l] * (share / 2);
                    change += _dynamics.Axis[first + l] * share;
                }

                AxisChanges[first + k] = new SharedTwist(change, arm);
                response.AddBoth(_dynamics.Axis[first + k], half);
            }

            Links[i] = response;
        }
    }

    /// <summary>An impulse on a link at its centre of mass.</summary>
    public void Apply(int link, in Wrench impulse)
    {
        var passed = new SharedWrench(impulse, Arms[link]);
        for (int i = link; i > 0; i = _tree.Parents[i])
        {
            SharedWrench at = passed;
            for (int f = _tree.FirstFreedom[i]; f < _tree.FirstFreedom[i + 1]; f++)
            {
                double onFreedom = SharedTwist.Dot(at, Axis[f]);
                Kept[f] += onFreedom;
                passed -= Reactions[f] * onFreedom;
            }
        }

        RootKept += passed;
    }

    /// <summary>Change of a link's motion by all that is kept.</summary>
    public Twist Change(int link)
    {
        int depth = 0;
        for (int i = link; i > 0; i = _tree.Parents[i])
            _path[depth++] = i;
        SharedTwist change = RootChange;
        while (depth > 0)
        {
            int i = _path[--depth];
            SharedTwist above = change;
            for (int f = _tree.FirstFreedom[i]; f < _tree.FirstFreedom[i + 1]; f++)
                change += Axis[f] * Speed(i, f, above);
        }

        return change.At(Arms[link]);
    }

    /// <summary>Change of a freedom's speed by all that is kept, once that of the link above is known.</summary>
    public double Speed(int link, int freedom, in SharedTwist above)
    {
        int first = _tree.FirstFreedom[link];
        int count = _tree.FirstFreedom[link + 1] - first;
        int row = link * 9 + 3 * (freedom - first);
        double speed = -SharedTwist.Dot(Reactions[freedom], above);
        for (int l = 0; l < count; l++)
            speed += _dynamics.InverseInertias[row + l] * Kept[first + l];
        return speed;
    }

    /// <summary>Takes back all that is kept.</summary>
    public void Forget()
    {
        RootKept = default;
        Array.Clear(Kept, 0, Kept.Length);
    }

    /// <summary>Adds what is kept to the links' motions and the joints' speeds, and keeps nothing any more.</summary>
    /// <param name="motions">Of the links.</param>
    /// <param name="speeds">Of the freedoms.</param>
    /// <param name="startSpeeds">Of the freedoms, as the links' motions have them.</param>
    public void Flush(Twist[] motions, double[] speeds, double[] startSpeeds)
    {
        SharedTwist[] changes = _changes;
        changes[0] = RootChange;
        motions[0] += changes[0].At(Vector3d.Zero);
        for (int i = 1; i < _tree.Count; i++)
        {
            ref SharedTwist above = ref changes[_tree.Parents[i]];
            SharedTwist change = above;
            for (int f = _tree.FirstFreedom[i]; f < _tree.FirstFreedom[i + 1]; f++)
            {
                double speed = Speed(i, f, above);
                speeds[f] += speed;
                startSpeeds[f] += speed;
                change += Axis[f] * speed;
            }

            changes[i] = change;
            motions[i] += change.At(Arms[i]);
        }

        Forget();
    }
}
