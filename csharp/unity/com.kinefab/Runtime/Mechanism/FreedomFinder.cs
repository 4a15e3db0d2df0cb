using System;
using System.Collections.Generic;
using Kinefab.Kinematics;
using Kinefab.Validation;
using Doc = Kinefab.Document;

namespace KinefabUnity
{
    /// <summary>Finds the freedoms of a mechanism, their ranges from the exported pose, and its islands: once, when the scene is imported.</summary>
    internal static class FreedomFinder
    {
        // What a slider shows of an open range: half a turn each way, or twice a link's length.
        private const double HalfTurn = 180;
        private const double LengthsLooked = 100;
        private const double LengthsShown = 2;

        // Freedoms times bodies up to which ranges are looked for, some seconds at most; beyond it they are the joints' own limits.
        private const int MostSearched = 20000;

        public static KinefabFreedom[] Find(Mechanism mechanism, int[] islandOf)
        {
            IReadOnlyList<int> chosen = mechanism.ChooseFreedoms();
            var found = new KinefabFreedom[chosen.Count];
            var sweep = new Sweep(new PositionSolver(mechanism));
            MechanismState home = mechanism.NewState();
            bool searches = (long)chosen.Count * mechanism.Bodies.Count <= MostSearched;
            for (int i = 0; i < found.Length; i++)
            {
                MechanismCoordinate own = mechanism.Coordinates[chosen[i]];
                found[i] = new KinefabFreedom(own.ShortName, own.Name, chosen[i], own.IsAngle, islandOf[own.GameObject]);
                if (searches)
                {
                    (RangeLimit low, RangeLimit high) = sweep.Range(home, chosen[i]);
                    SetRange(found[i], own, low.Value, low.End == RangeEnd.Open, high.Value, high.End == RangeEnd.Open);
                    continue;
                }

                foreach (JointFreedom freedom in mechanism.Scene.Freedoms(own.GameObject, own.Component))
                {
                    if (freedom.Coordinate == own.Coordinate)
                    {
                        bool isOpen = double.IsInfinity(freedom.Lower) || double.IsInfinity(freedom.Upper);
                        SetRange(found[i], own, isOpen ? -LengthsLooked : freedom.Lower, isOpen, isOpen ? LengthsLooked : freedom.Upper, isOpen);
                    }
                }
            }

            return found;
        }

        /// <summary>For each GameObject the number of its island, by the file's analysis or else by the joints; -1: it does not move.</summary>
        public static int[] Islands(Mechanism mechanism)
        {
            ValidScene scene = mechanism.Scene;
            var islandOf = new int[scene.Document.GameObjects.Count];
            Array.Fill(islandOf, -1);
            int number = 0;
            if (scene.Document.Analysis is Doc.Analysis analysis && analysis.Islands.Count > 0)
            {
                foreach (Doc.AnalysisIsland island in analysis.Islands)
                {
                    Number(islandOf, island.GameObjects, number++);
                }

                // The analysis counts the source's bodies; those that stand between two of its joints are of their neighbours' island.
                while (Spread(scene, islandOf))
                {
                }
            }
            else
            {
                foreach (IslandMobility island in mechanism.CountMobility().Islands)
                {
                    Number(islandOf, island.GameObjects, number++);
                }
            }

            // What a body carries along is of its island.
            for (int i = 0; i < islandOf.Length; i++)
            {
                if (islandOf[i] < 0 && scene.BodyOf(i) is int body)
                {
                    islandOf[i] = islandOf[body];
                }
            }

            return islandOf;
        }

        private static void Number(int[] islandOf, IReadOnlyList<int> gameObjects, int island)
        {
            foreach (int gameObject in gameObjects)
            {
                if ((uint)gameObject < (uint)islandOf.Length)
                {
                    islandOf[gameObject] = island;
                }
            }
        }

        private static bool Spread(ValidScene scene, int[] islandOf)
        {
            bool isNew = false;
            for (int i = 0; i < islandOf.Length; i++)
            {
                foreach (Doc.Component component in scene.Document.GameObjects[i].Components)
                {
                    if (component is Doc.Joint joint && joint.ConnectedBody is int other)
                    {
                        isNew |= Take(scene, islandOf, i, other) | Take(scene, islandOf, other, i);
                    }
                }
            }

            return isNew;
        }

        private static bool Take(ValidScene scene, int[] islandOf, int from, int to)
        {
            if (islandOf[from] < 0 || islandOf[to] >= 0 || !(scene.Body(to) is Doc.Rigidbody body) || body.IsKinematic)
            {
                return false;
            }

            islandOf[to] = islandOf[from];
            return true;
        }

        private static void SetRange(KinefabFreedom freedom, MechanismCoordinate own, double lowest, bool openBelow, double highest, bool openAbove)
        {
            if (own.IsAngle && openBelow && openAbove)
            {
                lowest = -HalfTurn;
                highest = HalfTurn;
            }
            else if (!own.IsAngle)
            {
                lowest = openBelow ? lowest * LengthsShown / LengthsLooked : lowest;
                highest = openAbove ? highest * LengthsShown / LengthsLooked : highest;
            }

            double a = own.ToCad(lowest), b = own.ToCad(highest);
            if (a <= b)
            {
                freedom.SetRange(a, openBelow, b, openAbove);
            }
            else
            {
                freedom.SetRange(b, openAbove, a, openBelow);
            }
        }
    }
}
