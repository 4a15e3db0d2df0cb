namespace Kinefab.Dynamics.Pgs;

/// <summary>
/// Where a joint's rows are: springs and motors from Start, then equalities, then inequalities. Equalities are solved together, all
/// others in turn. Without preprocessing every row is solved in turn, and Equalities and Inequalities are End.
/// </summary>
internal struct JointBlock
{
    public int Joint;

    /// <summary>Slot of body 0; that after the last body stands for the world.</summary>
    public int Body0;
    public int Body1;

    /// <summary>
    /// Slot that takes body 0's change: its own, or one that nobody reads where the body cannot move. Else every joint on the world
    /// would have to wait for the one before it to write the same zeros.
    /// </summary>
    public int Moved0;
    public int Moved1;
    public int Start;
    public int Equalities;
    public int Inequalities;
    public int End;

    /// <summary>The first of the factors that preprocessing wrote.</summary>
    public int Factors;
    public PairMass Mass;
}
