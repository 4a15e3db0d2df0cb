using System;
using System.Collections.Generic;
using Kinefab.Kinematics;

namespace KinefabUnity
{
    /// <summary>Finds the freedoms of a mechanism, their ranges from the exported pose, and its islands: once, when the scene is imported.</summary>
    internal static class FreedomFinder
    {
        // What a slider shows of an open range: half a turn each way, or twice a link's length.
        private const double HalfTurn = 180;
        private const double LengthsLooked = 100;
        private const double LengthsShown = 2;

        public static KinefabFreedom[] Find(Mechanism mechanism, int[] islandOf)
        {
            IReadOnlyList<int> chosen = mechanism.ChooseFreedoms();
            var found = new KinefabFreedom[chosen.Count];
            var sweep = new Sweep(new PositionSolver(mechanism));
            MechanismState home = mechanism.NewState();
            for (int i = 0; i < found.Length; i++)
            {
                MechanismCoordinate own = mechanism.Coordinates[chosen[i]];
                found[i] = new KinefabFreedom(own.ShortName, own.Name, chosen[i], own.IsAngle, islandOf[own.GameObject]);
                (RangeLimit low, RangeLimit high) = sweep.Range(home, chosen[i]);
                SetRange(found[i], own, low, high);
            }

            return found;
        }

        /// <summary>For each GameObject the number of its island, by the file's analysis or else by the joints; -1: it does not move.</summary>
        public static int[] Islands(Mechanism mechanism)
        {
            int count = mechanism.Scene.Document.GameObjects.Count;
            var islandOf = new int[count];
            Array.Fill(islandOf, -1);
            int number = 0;
            if (mechanism.Scene.Document.Analysis is Kinefab.Document.Analysis analysis && analysis.Islands.Count > 0)
            {
                foreach (Kinefab.Document.AnalysisIsland island in analysis.Islands)
                {
                    Number(island.GameObjects, number++);
                }
            }
            else
            {
                foreach (IslandMobility island in mechanism.CountMobility().Islands)
                {
                    Number(island.GameObjects, number++);
                }
            }

            // What a body carries along is of its island.
            for (int i = 0; i < count; i++)
            {
                if (islandOf[i] < 0 && mechanism.Scene.BodyOf(i) is int body)
                {
                    islandOf[i] = islandOf[body];
                }
            }

            return islandOf;

            void Number(IReadOnlyList<int> gameObjects, int island)
            {
                foreach (int gameObject in gameObjects)
                {
                    if ((uint)gameObject < (uint)islandOf.Length)
                    {
                        islandOf[gameObject] = island;
                    }
                }
            }
        }

        private static void SetRange(KinefabFreedom freedom, MechanismCoordinate own, RangeLimit low, RangeLimit high)
        {
            bool openBelow = low.End == RangeEnd.Open, openAbove = high.End == RangeEnd.Open;
            double lowest = low.Value, highest = high.Value;
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
