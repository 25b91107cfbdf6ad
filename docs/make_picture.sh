#!/bin/sh
# Makes docs/picture.png with the program given as the first argument; needs Python with Pillow to put the pictures side by side.
set -e
folder=$(mktemp -d)
surface="--model gauss --set n=1.5,k=0,sigma=0.15,ks=1,kd=0.02,kv=0 --size 360"
"$1" picture $surface --lamp 70,135 --show dolp -o "$folder/1.png"
"$1" picture $surface --sky 1 --show dolp -o "$folder/2.png"
"$1" picture $surface --sky 1 --show aop -o "$folder/3.png"
"${PYTHON:-python3}" - "$folder" "$(dirname "$0")/picture.png" <<'P'
import sys
from PIL import Image
images = [Image.open(f"{sys.argv[1]}/{n}.png").convert("RGB") for n in (1, 2, 3)]
whole = Image.new("RGB", (sum(i.width for i in images), images[0].height), "white")
left = 0
for image in images:
    whole.paste(image, (left, 0))
    left += image.width
whole.save(sys.argv[2], optimize=True)
P
rm -r "$folder"
