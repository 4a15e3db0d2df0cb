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

    /// <summary>Slot that takes what the joint does to body 0; not that of a body that cannot move, or all joints on it would wait for each other.</summary>
    public int Moved0;
    public int Moved1;
    public int Start;
    public int Equalities;
    public int Inequalities;
    public int End;

    /// <summary>The first of preprocessing's factors, which are Preprocessing.Factors many.</summary>
    public int Factors;
    public PairMass Mass;
}
