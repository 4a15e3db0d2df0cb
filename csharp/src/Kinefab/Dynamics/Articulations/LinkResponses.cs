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
    private readonly ArticulationTree _tree;
    private readonly ForwardDynamics _dynamics;

    /// <summary>Change of a link's motion by an impulse at its centre of mass; see <see cref="FindResponses"/>.</summary>
    public readonly SpatialMatrix[] Links;

    /// <summary>Impulses kept at the freedoms.</summary>
    public readonly double[] Kept;

    /// <summary>Changes of the joints' speeds, scratch.</summary>
    public readonly double[] Changes;

    /// <summary>Impulse kept at the root.</summary>
    public Wrench RootKept;

    private readonly int[] _path;

    public LinkResponses(ArticulationTree tree, ForwardDynamics dynamics)
    {
        _tree = tree;
        _dynamics = dynamics;
        Links = new SpatialMatrix[tree.Count];
        Kept = new double[tree.Freedoms];
        Changes = new double[tree.Freedoms];
        _path = new int[tree.Count];
    }

    /// <summary>Of all links, outwards: L' = (1 - S D^-1 (IS)^T) X L X^T (..)^T + S D^-1 S^T.</summary>
    public void FindResponses()
    {
        Links[0] = _dynamics.RootResponse;
        Span<Twist> seen = stackalloc Twist[ArticulationTree.MostAxes];
        for (int i = 1; i < _tree.Count; i++)
        {
            SpatialMatrix response = Links[_tree.Parents[i]].From(_dynamics.Levers[i] * -1);
            int first = _tree.FirstFreedom[i];
            int count = _tree.FirstFreedom[i + 1] - first;
            for (int k = 0; k < count; k++)
                seen[k] = response.Times(_dynamics.Reactions[first + k]);
            for (int k = 0; k < count; k++)
            {
                // S_k k_k^T + k_k S_k^T leaves, and S_k S_l^T (D^-1 + R^T L R)_kl comes; half of it in each of two outer products.
                Twist half = seen[k] * -1;
                for (int l = 0; l < count; l++)
                {
                    double share = _dynamics.InverseInertias[i * 9 + 3 * k + l] + Wrench.Dot(_dynamics.Reactions[first + l], seen[k]);
                    half += _dynamics.Axis[first + l] * (share / 2);
                }

                response.AddBoth(_dynamics.Axis[first + k], half);
            }

            Links[i] = response;
        }
    }

    /// <summary>An impulse on a link at its centre of mass.</summary>
    public void Apply(int link, Wrench impulse) => RootKept += Inwards(link, impulse, Kept);

    /// <summary>Change of a link's motion by all that is kept.</summary>
    public Twist Change(int link) => Outwards(link, _dynamics.RootResponse.Times(RootKept), Kept);

    /// <summary>Takes back all that is kept.</summary>
    public void Forget()
    {
        RootKept = default;
        Array.Clear(Kept, 0, Kept.Length);
    }

    /// <summary>Adds what is kept to the links' motions and the joints' speeds, and keeps nothing any more.</summary>
    /// <param name="motions">Of the links.</param>
    /// <param name="speeds">Of the freedoms.</param>
    /// <param name="changes">Scratch, one for each link.</param>
    public void Flush(Twist[] motions, double[] speeds, Twist[] changes)
    {
        changes[0] = _dynamics.RootResponse.Times(RootKept);
        motions[0] += changes[0];
        for (int i = 1; i < _tree.Count; i++)
        {
            Twist change = changes[_tree.Parents[i]].At(_dynamics.Levers[i]);
            _dynamics.Answer(i, change, Kept, Changes);
            for (int f = _tree.FirstFreedom[i]; f < _tree.FirstFreedom[i + 1]; f++)
            {
                speeds[f] += Changes[f];
                change += _dynamics.Axis[f] * Changes[f];
                Kept[f] = 0;
            }

            changes[i] = change;
            motions[i] += change;
        }

        RootKept = default;
    }

    private Wrench Inwards(int link, Wrench impulse, double[] kept)
    {
        for (int i = link; i > 0; i = _tree.Parents[i])
        {
            Wrench passed = impulse;
            for (int f = _tree.FirstFreedom[i]; f < _tree.FirstFreedom[i + 1]; f++)
            {
                double onFreedom = Wrench.Dot(impulse, _dynamics.Axis[f]);
                kept[f] += onFreedom;
                passed -= _dynamics.Reactions[f] * onFreedom;
            }

            impulse = passed.From(_dynamics.Levers[i]);
        }

        return impulse;
    }

    private Twist Outwards(int link, Twist change, double[] kept)
    {
        int depth = 0;
        for (int i = link; i > 0; i = _tree.Parents[i])
            _path[depth++] = i;
        while (depth > 0)
        {
            int i = _path[--depth];
            change = change.At(_dynamics.Levers[i]);
            _dynamics.Answer(i, change, kept, Changes);
            for (int f = _tree.FirstFreedom[i]; f < _tree.FirstFreedom[i + 1]; f++)
                change += _dynamics.Axis[f] * Changes[f];
        }

        return change;
    }
}
