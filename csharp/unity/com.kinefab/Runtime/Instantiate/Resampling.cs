using System;

namespace KinefabUnity
{
    /// <summary>
    /// One channel of an image in another size, as the exporter makes it for prefabs: Keys' cubic (1981, a = -1/2), made wider where the image
    /// shrinks, along the rows and then along the columns, in Pillow's whole numbers, so that both make the same bytes.
    /// </summary>
    internal static class Resampling
    {
        private const double Cubic = -0.5;
        private const double Support = 2;

        // Of a weight, binary digits behind the point.
        private const int Digits = 32 - 8 - 2;

        /// <param name="from">Row by row, from the top.</param>
        /// <param name="width">Of the image.</param>
        /// <param name="height">Of the image.</param>
        /// <param name="newWidth">Of the result.</param>
        /// <param name="newHeight">Of the result.</param>
        internal static byte[] Resized(byte[] from, int width, int height, int newWidth, int newHeight)
        {
            byte[] wide = width == newWidth ? from : Along(from, width, newWidth, height, width, newWidth, 1);
            return height == newHeight ? wide : Along(wide, height, newHeight, newWidth, 1, 1, newWidth);
        }

        // Lines of one image, each resampled: lines lie lineFrom and lineTo apart, the numbers of a line step.
        private static byte[] Along(byte[] from, int size, int newSize, int lines, int lineFrom, int lineTo, int step)
        {
            var to = new byte[lines * newSize];
            double scale = (double)size / newSize;
            double wider = Math.Max(1, scale);
            double reach = Support * wider;
            for (int at = 0; at < newSize; at++)
            {
                double centre = (at + 0.5) * scale;
                int first = Math.Max(0, (int)(centre - reach + 0.5));
                int count = Math.Min(size, (int)(centre + reach + 0.5)) - first;
                int[] weights = Weights(first - centre + 0.5, 1 / wider, count);
                for (int line = 0; line < lines; line++)
                {
                    int sum = 1 << (Digits - 1);
                    for (int k = 0; k < count; k++)
                    {
                        sum += weights[k] * from[line * lineFrom + (first + k) * step];
                    }

                    to[line * lineTo + at * step] = (byte)Math.Min(byte.MaxValue, Math.Max(0, sum >> Digits));
                }
            }

            return to;
        }

        private static int[] Weights(double start, double scale, int count)
        {
            var plain = new double[count];
            double sum = 0;
            for (int k = 0; k < count; k++)
            {
                plain[k] = Weight((k + start) * scale);
                sum += plain[k];
            }

            var weights = new int[count];
            for (int k = 0; k < count; k++)
            {
                double share = sum != 0 ? plain[k] / sum : plain[k];
                weights[k] = (int)((share < 0 ? -0.5 : 0.5) + share * (1 << Digits));
            }

            return weights;
        }

        private static double Weight(double x)
        {
            x = Math.Abs(x);
            if (x < 1)
            {
                return ((Cubic + 2) * x - (Cubic + 3)) * x * x + 1;
            }

            return x < Support ? (((x - 5) * x + 8) * x - 4) * Cubic : 0;
        }
    }
}
