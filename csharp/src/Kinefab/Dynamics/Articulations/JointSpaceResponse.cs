using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Articulations;

/// <summary>
/// What impulses on the joints of an articulation do to all joints' speeds, as one matrix: with few freedoms a sweep by it is faster than one
/// through the tree. The articulated-body algorithm is a factorisation of it, H^-1 = W^T D^-1 W, where W holds what a unit of impulse on one freedom
/// is at the freedoms above. Source: Rodriguez, Jain, Kreutz-Delgado, A spatial operator algebra for manipulator modeling and control, 1991.
/// </summary>
internal sealed class JointSpaceResponse
{
    /// <summary>Building the matrix grows with the square of the freedoms and the depth: from here on the tree is faster.</summary>
    public const int MostFreedoms = 16;

    private const int Axes = ArticulationTree.MostAxes;
    private const int Lanes = 4;

    private readonly ArticulationTree _tree;
    private readonly ForwardDynamics _dynamics;
    private readonly int _stride;

    // W and H^-1, rows first; columns of H^-1 are filled up to whole lanes.
    private readonly double[] _inwards;
    private readonly double[] _matrix;
    private readonly double[] _scaled;

    // At the root, about its centre of mass, by a unit on each freedom.
    private readonly Wrench[] _atRoot;
    private readonly Twist[] _changes;

    public JointSpaceResponse(ArticulationTree tree, ForwardDynamics dynamics)
    {
        _tree = tree;
        _dynamics = dynamics;
        int m = tree.Freedoms;
        _stride = PaddedCount(m);
        _inwards = new double[m * m];
        _matrix = new double[m * _stride];
        _scaled = new double[m];
        _atRoot = new Wrench[m];
        _changes = new Twist[tree.Count];
    }

    /// <summary>Length of an array of speeds for <see cref="Add"/>.</summary>
    public static int PaddedCount(int freedoms) => (freedoms + Lanes - 1) / Lanes * Lanes;

    /// <summary>Change of a freedom's speed by a unit of impulse on it.</summary>
    public double Own(int freedom) => _matrix[freedom * _stride + freedom];

    /// <summary>Needs the articulated inertias.</summary>
    public void Find()
    {
        int m = _tree.Freedoms;
        for (int link = 1; link < _tree.Count; link++)
        {
            for (int j = _tree.FirstFreedom[link]; j < _tree.FirstFreedom[link + 1]; j++)
                FindRow(link, j, m);
        }
    }

    /// <summary>Adds what an impulse on a freedom does to all of them.</summary>
    public void Add(int freedom, double impulse, double[] speeds)
    {
        int row = freedom * _stride;
        for (int f = 0; f < _stride; f += Lanes)
            (Double4.Load(speeds, f) + impulse * Double4.Load(_matrix, row + f)).Store(speeds, f);
    }

    /// <summary>Adds changes of the joints' speeds, and of a floating root by impulses on the joints, to the links' motions.</summary>
    public void Move(ReadOnlySpan<double> speedChanges, ReadOnlySpan<double> impulses, Twist[] motions)
    {
        Wrench atRoot = default;
        for (int f = 0; !_tree.IsFixed && f < impulses.Length; f++)
            atRoot += _atRoot[f] * impulses[f];
        _changes[0] = _dynamics.RootResponse.Times(atRoot);
        motions[0] += _changes[0];
        for (int i = 1; i < _tree.Count; i++)
        {
            Twist change = _changes[_tree.Parents[i]].At(_dynamics.Levers[i]);
            for (int f = _tree.FirstFreedom[i]; f < _tree.FirstFreedom[i + 1]; f++)
                change += _dynamics.Axis[f] * speedChanges[f];
            _changes[i] = change;
            motions[i] += change;
        }
    }

    // Row j of W up to j, then row and column j of H^-1 up to j.
    private void FindRow(int link, int j, int m)
    {
        double[] inwards = _inwards;
        int row = j * m;
        inwards[row + j] = 1;
        Wrench passed = _dynamics.Reactions[j] * -1;
        Scale(link, row);
        int above = link;
        for (int l = _tree.Parents[link]; l > 0; l = _tree.Parents[l])
        {
            passed = passed.From(_dynamics.Levers[above]);
            above = l;
            Wrench at = passed;
            for (int f = _tree.FirstFreedom[l]; f < _tree.FirstFreedom[l + 1]; f++)
            {
                double onFreedom = Wrench.Dot(at, _dynamics.Axis[f]);
                inwards[row + f] = onFreedom;
                passed -= _dynamics.Reactions[f] * onFreedom;
            }

            Scale(l, row);
        }

        passed = passed.From(_dynamics.Levers[above]);
        _atRoot[j] = passed;
        Twist root = _tree.IsFixed ? default : _dynamics.RootResponse.Times(passed);
        for (int k = 0; k <= j; k++)
        {
            double sum = _tree.IsFixed ? 0 : Wrench.Dot(_atRoot[k], root);
            for (int f = 0; f <= k; f++)
                sum += _scaled[f] * inwards[k * m + f];
            _matrix[j * _stride + k] = sum;
            _matrix[k * _stride + j] = sum;
        }

        Array.Clear(_scaled, 0, m);
    }

    // D^-1 times a row's part at one joint.
    private void Scale(int link, int row)
    {
        int first = _tree.FirstFreedom[link];
        int count = _tree.FirstFreedom[link + 1] - first;
        for (int k = 0; k < count; k++)
        {
            double sum = 0;
            for (int l = 0; l < count; l++)
                sum += _dynamics.InverseInertias[(link * Axes + k) * Axes + l] * _inwards[row + first + l];
            _scaled[first + k] = sum;
        }
    }
}
